"""python3 -m terminal_language: copies stdin to stdout, our texts in the language of the locale."""

import sys

from terminal_language.wanted import start

start()
for line in sys.stdin:
    print(line, end="", flush=True)
