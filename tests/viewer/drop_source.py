"""Drops files on a window as a file manager does: the XDND protocol, version 5, https://www.freedesktop.org/wiki/Specifications/XDND/"""

import time
from pathlib import Path

from Xlib import X, display
from Xlib.protocol import event

VERSION = 5


class DropSource:
    """A window of its own, from which files are dragged."""

    def __init__(self, display_name):
        self.display = display.Display(display_name)
        self.window = self.display.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        self.list = self.atom("text/uri-list")

    def atom(self, name):
        return self.display.intern_atom(name)

    def send(self, target, kind, *data):
        words = [self.window.id, *data] + [0] * (4 - len(data))
        target.send_event(event.ClientMessage(window=target, client_type=self.atom(kind), data=(32, words)))
        self.display.flush()

    def answer(self, request, content):
        """Gives the target of a drop the list of files that it asks for."""
        request.requestor.change_property(request.property, request.target, 8, content)
        request.requestor.send_event(event.SelectionNotify(time=request.time, requestor=request.requestor, selection=request.selection,
                                                           target=request.target, property=request.property))
        self.display.flush()

    def wait(self, kind, content, timeout):
        """The target's next message of this kind; what it asks for until then is answered."""
        end = time.time() + timeout
        while time.time() < end:
            while self.display.pending_events():
                got = self.display.next_event()
                if got.type == X.SelectionRequest:
                    self.answer(got, content)
                elif got.type == X.ClientMessage and got.client_type == self.atom(kind):
                    return got
            time.sleep(0.02)
        raise AssertionError("the window does not answer a drop with " + kind)

    def drop(self, window_id, x, y, path, timeout=60):
        """Drags the file at `path` to (x, y) on the screen, over a window there, and lets go of it."""
        content = (Path(path).absolute().as_uri() + "\r\n").encode()
        target = self.display.create_resource_object("window", window_id)
        self.window.set_selection_owner(self.atom("XdndSelection"), X.CurrentTime)
        self.send(target, "XdndEnter", VERSION << 24, self.list)
        self.send(target, "XdndPosition", 0, x << 16 | y, X.CurrentTime, self.atom("XdndActionCopy"))
        accepted = self.wait("XdndStatus", content, timeout)
        assert accepted.data[1][1] & 1, "the window takes no files"
        self.send(target, "XdndDrop", 0, X.CurrentTime)
        finished = self.wait("XdndFinished", content, timeout)
        assert finished.data[1][1] & 1, "the window could not read the list of files"
