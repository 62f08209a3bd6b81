"""Drives `tessera view` on a display without a screen: clicks and types with xdotool, reads what the window reports with --ui-state."""

import json
import os
import shutil
import subprocess
import time

try:
    from drop_source import DropSource
except ImportError:
    DropSource = None

TOOLS = ("Xvfb", "xdotool", "import", "compare")


def missing_tools():
    return [tool for tool in TOOLS if shutil.which(tool) is None] + ([] if DropSource else ["python3-xlib"])


class Display:
    """An Xvfb of 24 bits with a number of its own."""

    def __init__(self, size="1400x900"):
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", size + "x24", "-nolisten", "tcp", "-r"],  # -r: keys do not repeat
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as numbers:
            self.name = ":" + numbers.readline().strip()

    def stop(self):
        self.process.terminate()
        self.process.wait()


class Viewer:
    """A running viewer. Every wait ends with an error that says what was waited for."""

    def __init__(self, program, arguments, folder, display, pictures=None):
        self.environment = dict(os.environ, DISPLAY=display.name)
        # A library to load into the viewer, such as liblsan.so: it makes leaks the exit code.
        environment = dict(self.environment)
        if "TESSERA_VIEWER_PRELOAD" in os.environ:
            environment["LD_PRELOAD"] = os.environ["TESSERA_VIEWER_PRELOAD"]
        self.folder, self.pictures = folder, pictures
        self.state_file = os.path.join(folder, "ui_state.json")
        self.log_file = os.path.join(folder, "viewer.log")
        self.written = 0
        self.pause = 0.35  # long enough for two frames of the window: it must see the mouse rest before it sees a click
        with open(self.log_file, "w") as log:
            self.process = subprocess.Popen([program, "view", *arguments, "--ui-state", self.state_file], cwd=folder, env=environment,
                                            stdout=log, stderr=log)

    def log(self):
        with open(self.log_file) as log:
            return log.read()

    def run(self, *command):
        return subprocess.run(command, env=self.environment, check=True, capture_output=True, text=True).stdout

    def tool(self, *arguments):
        self.run("xdotool", *[str(argument) for argument in arguments])

    def key(self, name, pause=None):
        """The viewer's own keys are events; those of text fields must be held while a frame sees them."""
        self.tool("keydown", name)
        time.sleep(pause or (self.pause if name in ("Tab", "Return", "BackSpace", "a") else 0.1))
        self.tool("keyup", name)

    def keys(self, modifier, name):
        """A key while a modifier is held."""
        self.tool("keydown", modifier)
        self.key(name)
        self.tool("keyup", modifier)

    def state(self, timeout=240):
        """What the window reports now."""
        end = time.time() + timeout
        while time.time() < end:
            assert self.process.poll() is None, "the viewer has ended:\n" + self.log()
            self.key("F9", 0.05)
            asked = time.time()
            while time.time() < min(asked + 5, end):
                try:
                    with open(self.state_file) as file:
                        state = json.load(file)
                except (FileNotFoundError, json.JSONDecodeError):
                    state = {"written": 0}
                if state["written"] > self.written:
                    self.written = state["written"]
                    self.pause = max(0.35, min(2.5 * state["frame"]["frame_ms"] / 1000, 4))
                    return state
                time.sleep(0.05)
        raise AssertionError("the viewer reports nothing\n" + self.log())

    def wait(self, what, condition, timeout=120):
        """The first state for which the condition holds."""
        end = time.time() + timeout
        state = None
        while time.time() < end:
            state = self.state(max(timeout, 240))
            if condition(state):
                return state
            time.sleep(0.1)
        state.pop("widgets", None)
        raise AssertionError("waited in vain for: %s\n%s\n%s" % (what, json.dumps(state, indent=1), self.log()))

    def settled(self, timeout=120):
        """A state after a frame that was begun after this call."""
        number = self.state()["frame"]["number"]
        return self.wait("two more frames", lambda s: s["frame"]["number"] >= number + 2, timeout)

    def place(self, widget):
        places = self.state()["widgets"]
        assert widget in places, "there is no %s; there are %s" % (widget, sorted(places))
        assert places[widget]["visible"], widget + " is out of sight"
        low, high = places[widget]["low"], places[widget]["high"]
        return low, high

    def press(self, x, y, button=1):
        self.tool("mousemove", int(x), int(y))
        time.sleep(self.pause)
        self.tool("mousedown", button)
        time.sleep(self.pause)
        self.tool("mouseup", button)
        time.sleep(self.pause)

    def click(self, widget, along=0.5):
        low, high = self.place(widget)
        self.press(low[0] + (high[0] - low[0]) * along, (low[1] + high[1]) / 2)

    def choose(self, widget, choice):
        """An entry of a list that opens."""
        self.click(widget)
        self.wait("the list of " + widget, lambda s: widget + "." + choice in s["widgets"])
        self.click(widget + "." + choice)

    def drag(self, start, end, button=1):
        self.tool("mousemove", *start)
        time.sleep(self.pause)
        self.tool("mousedown", button)
        time.sleep(self.pause)
        steps = 6
        for i in range(1, steps + 1):
            time.sleep(self.pause / 3)
            self.tool("mousemove", *[int(a + (b - a) * i / steps) for a, b in zip(start, end)])
        time.sleep(self.pause)
        self.tool("mouseup", button)
        time.sleep(self.pause)

    def type(self, text):
        self.tool("type", "--delay", "25", text)
        time.sleep(self.pause)

    def clear_field(self):
        self.keys("ctrl", "a")
        self.key("BackSpace")

    def drop(self, path, x, y):
        """A file, dragged from elsewhere and let go over a place on the screen."""
        window = int(self.run("xdotool", "search", "--name", "^tessera").split()[0])
        source = DropSource(self.environment["DISPLAY"])
        try:
            source.drop(window, x, y, path)
        finally:
            source.display.close()

    def picture(self, name):
        """Keeps a picture of the whole window when pictures are wanted."""
        if self.pictures:
            path = os.path.join(self.pictures, name + ".png")
            self.run("import", "-window", "root", "-crop", "1280x720+0+0", "+repage", "+dither", "-colors", "40", "-define", "png:compression-level=9", path)

    def quit(self, timeout=60):
        self.keys("ctrl", "q")
        return self.process.wait(timeout)

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
