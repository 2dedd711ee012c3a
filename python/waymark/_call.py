# SPDX-License-Identifier: Apache-2.0
"""Calls of workflows in a thread of their own, so that Ctrl-C and callbacks reach the caller."""

import logging
import os
import queue
import threading
import warnings

from . import errors

log = logging.getLogger("waymark")
_END = object()


def plain(value):
    """Returns paths as text, also inside lists."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return value


def keywords(**given):
    """Returns the keywords that are not None, with paths as text."""
    return {name: plain(value) for name, value in given.items() if value is not None}


def assignments(settings):
    """Returns {"a": True} as ["a=true"]."""
    def text(value):
        if isinstance(value, bool):
            return "true" if value else "false"
        return value if isinstance(value, str) else repr(value) if isinstance(value, float) else str(value)

    return [f"{name}={text(value)}" for name, value in settings.items()]


class Work:
    """A workflow in a thread. Iterating yields what it posts; `result` is what it returned."""

    def __init__(self, function, *arguments, progress=None, watch=False):
        self._posts = queue.SimpleQueue()
        self._stop = threading.Event()
        self._user_progress = progress
        self._finished = False
        self.result = None
        self._failure = None
        arguments += (self._post_rows,) if watch else ()
        self._thread = threading.Thread(
            target=self._run, args=(function, arguments), name="waymark", daemon=True)
        self._thread.start()

    def _run(self, function, arguments):
        try:
            self.result = function(*arguments, self._post_progress, self._post_message)
        except BaseException as failure:  # raised in the caller's thread
            self._failure = failure
        self._posts.put((_END, None))

    def _post_progress(self, stage, done, total, rate):
        if self._user_progress is not None:
            self._posts.put(("progress", (stage, done, total, rate)))
        return not self._stop.is_set()

    def _post_message(self, kind, text):
        self._posts.put((kind, text))

    def _post_rows(self, rows):
        self._posts.put(("rows", rows))
        return not self._stop.is_set()

    def stop(self):
        """Asks the workflow to stop, and waits until it has."""
        self._stop.set()
        self._thread.join()

    def __iter__(self):
        try:
            while not self._finished:
                kind, post = self._posts.get()
                if kind is _END:
                    self._finished = True
                elif kind == "rows":
                    yield post
                else:
                    self._deliver(kind, post)
        except BaseException:
            self.stop()
            raise
        if self._failure is not None:
            raise self._failure

    def _deliver(self, kind, post):
        if kind == "progress":
            self._user_progress(*post)
        elif kind == "warning":
            warnings.warn(post, errors.Warning, stacklevel=5)
        elif kind == "detail":
            log.debug(post.rstrip("\n"))
        else:
            log.info(post.rstrip("\n"))


def call(function, *arguments, progress=None):
    """Returns what function(*arguments, progress, message) of the module returns.

    progress(stage, done, total, rate) is called in this thread. Ctrl-C stops the work and raises KeyboardInterrupt.
    """
    work = Work(function, *arguments, progress=progress)
    for _ in work:
        pass
    return work.result
