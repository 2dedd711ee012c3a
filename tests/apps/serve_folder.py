#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Serves a folder on a free port while a command runs, and ends with its exit code.

usage: serve_folder.py [--no-ranges] FOLDER COMMAND...
{url} in the command becomes the address. The last line of standard output lists the ranges that were asked for and
whether the server gave them, as JSON. --no-ranges: whole files only, as http.server gives them.
"""
import functools
import http.server
import json
import os
import re
import subprocess
import sys
import threading


class Handler(http.server.SimpleHTTPRequestHandler):
    ranges, served = True, []

    def log_message(self, *_):
        pass

    def do_GET(self):
        wanted = re.fullmatch(r'bytes=(\d+)-(\d+)', self.headers.get('Range', ''))
        path = self.translate_path(self.path)
        if not wanted or not os.path.isfile(path):
            return super().do_GET()
        if not self.ranges:
            self.served.append([self.path, 'whole'])
            return super().do_GET()
        with open(path, 'rb') as file:
            file.seek(int(wanted[1]))
            part = file.read(int(wanted[2]) - int(wanted[1]) + 1)
        self.served.append([self.path, len(part)])
        self.send_response(206)
        self.send_header('Content-Type', 'application/octet-stream')
        self.send_header('Content-Range', f'bytes {wanted[1]}-{int(wanted[1]) + len(part) - 1}/{os.path.getsize(path)}')
        self.send_header('Content-Length', str(len(part)))
        self.send_header('Last-Modified', self.date_time_string(os.path.getmtime(path)))
        self.end_headers()
        self.wfile.write(part)


def main():
    words = sys.argv[1:]
    if words[0] == '--no-ranges':
        Handler.ranges = False
        words.pop(0)
    server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), functools.partial(Handler, directory=words[0]))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    url = f'http://127.0.0.1:{server.server_port}'
    code = subprocess.call([word.replace('{url}', url) for word in words[1:]])
    print(json.dumps(Handler.served), flush=True)
    return code


if __name__ == '__main__':
    sys.exit(main())
