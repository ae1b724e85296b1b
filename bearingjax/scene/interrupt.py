"""Ctrl-C as a wish: a sweep ends what is under way, and what is solved is kept."""

import os
import signal
import threading

_NOTE = (
    "\nbearingjax: interrupted: the cases under way are finished and kept; once more"
    " ends it at once\n"
)


class Interrupt:
    """While entered, Ctrl-C (SIGINT) and SIGTERM are noted; a second one kills.

    Called, it says whether one came: the `stop` of a sweep. Outside the main thread,
    which alone hears signals, it does nothing.

    Attributes:
        number: Signal that came, or `None`.
    """

    def __init__(self):
        self.number: int | None = None
        self._before = {}

    def __enter__(self):
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                if (
                    signal.getsignal(number) is not signal.SIG_IGN
                ):  # a job in the background
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *_):
        for number, handler in self._before.items():
            signal.signal(number, handler or signal.SIG_DFL)

    def __call__(self) -> bool:
        return self.number is not None

    def _note(self, number, _):
        self.number = number
        for each in self._before:
            signal.signal(each, signal.SIG_DFL)
        # Not print, which may be at work when the signal comes.
        os.write(2, _NOTE.encode())
