"""Handling of Ctrl-C: a sweep finishes the current block and keeps its results."""

import os
import signal
import threading

_NOTE = (
    "\nbearingjax: interrupted: the cases under way are finished and kept; once more"
    " ends it at once\n"
)


class Interrupt:
    """Context that records Ctrl-C (SIGINT) and SIGTERM; a second one kills.

    Calling it returns whether a signal was received: the `stop` of a sweep. Outside
    the main thread, which alone receives signals, it does nothing.

    Attributes:
        number: Signal received, or `None`.
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
        # Not print, which may be running when the signal arrives.
        os.write(2, _NOTE.encode())
