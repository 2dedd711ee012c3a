# SPDX-License-Identifier: Apache-2.0
"""Exceptions, by the exit codes of the program."""


class Error(RuntimeError):
    """A problem that the caller can fix. str() is the text that the program prints.

    problem: one line; where: file, option or position, may be empty; hint: what to do, may be empty;
    exit_code: that of the program.
    """

    exit_code = 1

    def __init__(self, problem, where="", hint=""):
        super().__init__(problem, where, hint)
        self.problem, self.where, self.hint = problem, where, hint

    def __str__(self):
        return "\n  ".join(part for part in (self.problem, self.where, self.hint) if part)


class UsageError(Error, ValueError):
    """A wrong argument, option or job; exit code 2."""

    exit_code = 2


class InputError(Error):
    """A missing, damaged or unsuitable file; exit code 1."""


class OutputError(Error):
    """A result that cannot be written; exit code 1."""


class EnvironmentError(Error):
    """Missing library data, memory or permissions; exit code 1."""


class UnitsFailed(Error):
    """The run finished, but some units failed; exit code 3. `result` is what was made."""

    exit_code = 3
    result = None


class Warning(UserWarning):
    """A warning of a workflow."""


_BY_CODE = {"usage": UsageError, "input": InputError, "output": OutputError, "environment": EnvironmentError}


def from_parts(code, problem, where, hint):
    """Returns the exception of an error of the C++ library."""
    return _BY_CODE[code](problem, where, hint)
