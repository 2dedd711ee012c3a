#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens a page in headless Chromium with software GL, carries out steps, and prints one line of JSON per step.

usage: view_browser.py PAGE.html[#STATE]|http://... STEP...
steps: eval:EXPRESSION            prints its value
       click:X,Y                  presses and releases the left button at CSS pixels
       clickon:EXPRESSION         the same at the {x, y} that the expression gives
       shot:FILE.png              writes a picture of the page
       dark, light                sets the preferred colours
       requests, errors           prints the network requests and the console errors so far
Exit code 77: Chromium is not installed.
"""
import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

SIZE = (1200, 800)


class Browser:
    """Chromium driven through the pipes of --remote-debugging-pipe."""

    def __init__(self, program, folder):
        to_browser, self.to = os.pipe()
        self.back, from_browser = os.pipe()

        self.process = subprocess.Popen(
            ['bash', '-c', f'exec "$0" "$@" 3<&{to_browser} 4>&{from_browser}', program, '--headless=new', '--no-sandbox', '--disable-gpu-sandbox', '--use-angle=swiftshader',
             '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--remote-debugging-pipe', '--no-first-run',
             '--disable-background-networking', '--disable-component-update', '--disable-extensions',
             '--hide-scrollbars', f'--user-data-dir={folder}', f'--window-size={SIZE[0]},{SIZE[1]}'],
            pass_fds=(to_browser, from_browser), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.number, self.session = b'', 0, None
        self.events = []

    def message(self):
        while b'\0' not in self.buffer:
            part = os.read(self.back, 1 << 20)
            if not part:
                raise RuntimeError('the browser has ended')
            self.buffer += part
        line, self.buffer = self.buffer.split(b'\0', 1)
        return json.loads(line)

    def call(self, method, **params):
        self.number += 1
        request = {'id': self.number, 'method': method, 'params': params}
        if self.session:
            request['sessionId'] = self.session
        os.write(self.to, json.dumps(request).encode() + b'\0')
        while True:
            got = self.message()
            if got.get('id') == request['id']:
                if 'error' in got:
                    raise RuntimeError(f"{method}: {got['error']}")
                return got['result']
            self.events.append(got)

    def evaluate(self, expression):
        got = self.call('Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True)
        if 'exceptionDetails' in got:
            raise RuntimeError(expression + ': ' + json.dumps(got['exceptionDetails'])[:2000])
        return got['result'].get('value')

    def click(self, x, y):
        for kind in ('mousePressed', 'mouseReleased'):
            self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left', clickCount=1)

    def settle(self):
        """Waits until the page has nothing more to draw."""
        for _ in range(400):
            if self.evaluate("!window.waymark || window.waymark.ready()"):
                return
            time.sleep(0.05)
        raise RuntimeError('the page does not come to rest: ' + json.dumps(self.errors()))

    def errors(self):
        found = []
        for event in self.events:
            params = event.get('params', {})
            if event.get('method') == 'Runtime.exceptionThrown':
                found.append(params['exceptionDetails'].get('exception', {}).get('description', 'exception'))
            if event.get('method') == 'Log.entryAdded' and params['entry']['level'] in ('error', 'warning'):
                found.append(params['entry']['text'])
        return found

    def requests(self):
        urls = [e['params']['request']['url'] for e in self.events if e.get('method') == 'Network.requestWillBeSent']
        return [url[:60] for url in urls if not url.startswith('data:')]


def main():
    program = shutil.which('chromium') or shutil.which('chromium-browser') or shutil.which('google-chrome')
    if program is None:
        return 77
    page, steps = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = Browser(program, folder)
        try:
            target = browser.call('Target.createTarget', url='about:blank')['targetId']
            browser.session = browser.call('Target.attachToTarget', targetId=target, flatten=True)['sessionId']
            for domain in ('Page', 'Runtime', 'Log', 'Network'):
                browser.call(domain + '.enable')
            browser.call('Emulation.setDeviceMetricsOverride', width=SIZE[0], height=SIZE[1], deviceScaleFactor=1,
                         mobile=False)
            path, _, state = page.partition('#')
            url = page if page.startswith('http://') else 'file://' + os.path.abspath(path) + ('#' + state if state else '')
            browser.call('Page.navigate', url=url)
            for _ in range(600):
                if browser.evaluate("document.readyState") == 'complete' and browser.evaluate("location.href") != 'about:blank':
                    break
                time.sleep(0.05)
            browser.settle()
            for step in steps:
                kind, _, text = step.partition(':')
                value = None
                if kind == 'eval':
                    value = browser.evaluate(text)
                elif kind == 'click':
                    browser.click(*map(float, text.split(',')))
                elif kind == 'clickon':
                    at = browser.evaluate(text)
                    browser.click(at['x'], at['y'])
                    value = at
                elif kind in ('dark', 'light'):
                    browser.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': kind}])
                elif kind == 'errors':
                    value = browser.errors()
                elif kind == 'requests':
                    value = browser.requests()
                browser.settle()
                if kind == 'shot':
                    data = browser.call('Page.captureScreenshot', format='png')['data']
                    with open(text, 'wb') as file:
                        file.write(base64.b64decode(data))
                print(json.dumps(value), flush=True)
        finally:
            browser.process.kill()
            browser.process.wait()
    return 0


if __name__ == '__main__':
    sys.exit(main())
