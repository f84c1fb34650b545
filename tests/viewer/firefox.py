"""A headless Firefox that tests of pages talk to, by Marionette, the protocol of Firefox's own tests, over a socket."""

import base64
import json
import os
import shutil
import signal
import socket
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep

from tests.viewer.browser import LONGEST, Browser

FIREFOX = next((path for name in ("firefox-esr", "firefox") if (path := shutil.which(name))), None)
PREFERENCES = {
    "marionette.port": 0,  # a free port, which Firefox writes into its profile
    "app.update.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "browser.startup.page": 0,
    "datareporting.policy.dataSubmissionEnabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "toolkit.telemetry.enabled": False,
}
ERRORS = """
return Services.console.getMessageArray()
    .filter(entry => entry instanceof Ci.nsIScriptError && !(entry.flags & Ci.nsIScriptError.warningFlag))
    .filter(entry => entry.sourceName.startsWith("file:"))
    .map(entry => entry.errorMessage)
    // said of an element whose children are still being read
    .filter(message => !message.includes("Incorrect number of children"));
"""


class Firefox:
    """A running Firefox with one page at a time; use it in a ``with`` statement."""

    def __init__(self, size=(1280, 900)):
        self.profile = TemporaryDirectory(prefix="symrot-firefox-", ignore_cleanup_errors=True)
        lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in PREFERENCES.items()]
        (Path(self.profile.name) / "user.js").write_text("\n".join(lines))
        self.process = subprocess.Popen(
            [FIREFOX, "--headless", "--marionette", "--remote-allow-system-access", "--no-remote",
             "--width", str(size[0]), "--height", str(size[1]), "--profile", self.profile.name, "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
            env=os.environ | {"HOME": self.profile.name},
        )  # fmt: skip
        self.number, self.rest = 0, b""
        self.socket = socket.create_connection(("127.0.0.1", self.port()), timeout=LONGEST)
        self.read()  # Firefox speaks first
        self.ask("WebDriver:NewSession", capabilities={"alwaysMatch": {"acceptInsecureCerts": True}})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.profile.cleanup()

    def port(self):
        """Return the port that Firefox listens on, once it has written it."""
        path, end = Path(self.profile.name) / "MarionetteActivePort", monotonic() + LONGEST
        while not (path.exists() and path.read_text()):
            if monotonic() > end or self.process.poll() is not None:
                raise RuntimeError("Firefox does not start")
            sleep(0.05)
        return int(path.read_text())

    def read(self):
        """Return the next message, which is written as ``length:JSON``."""
        while b":" not in self.rest:
            self.rest += self.piece()
        length, _, self.rest = self.rest.partition(b":")
        while len(self.rest) < int(length):
            self.rest += self.piece()
        text, self.rest = self.rest[: int(length)], self.rest[int(length) :]
        return json.loads(text)

    def piece(self):
        piece = self.socket.recv(1 << 16)
        if not piece:
            raise RuntimeError("Firefox has ended")
        return piece

    def ask(self, command, **parameters):
        """Send a command, and return its result."""
        self.number += 1
        text = json.dumps([0, self.number, command, parameters]).encode()
        self.socket.sendall(str(len(text)).encode() + b":" + text)
        _, _, error, result = self.read()
        if error:
            raise RuntimeError(f"{command}: {error['message']}")
        return result

    def in_firefox(self, script, *arguments):
        """Run a script with the rights of Firefox itself, and return its value."""
        self.ask("Marionette:SetContext", value="chrome")
        try:
            return self.ask("WebDriver:ExecuteScript", script=script, args=list(arguments))["value"]
        finally:
            self.ask("Marionette:SetContext", value="content")

    def open(self, path, *, dark=False, still=True, ready="window.symrot && !symrot.job && symrot.first"):
        """Open a page and wait until ``ready`` is true; ``still`` asks for reduced motion."""
        self.in_firefox(
            """Services.console.reset();
            Services.prefs.setIntPref("layout.css.prefers-color-scheme.content-override", arguments[0] ? 0 : 1);
            Services.prefs.setIntPref("ui.prefersReducedMotion", arguments[1] ? 1 : 0);""",
            dark, still,
        )  # fmt: skip
        self.ask("WebDriver:Navigate", url=Path(path).resolve().as_uri())
        self.wait(ready)

    def size(self, width, height):
        """Make the page ``width`` by ``height`` CSS pixels, however narrow; a window cannot be."""
        self.in_firefox(
            """const browser = gBrowser.selectedBrowser.closest(".browserStack");
            browser.style.flex = "none"; browser.style.width = arguments[0] + "px";
            browser.style.height = arguments[1] + "px";""",
            width, height,
        )  # fmt: skip

    @property
    def errors(self):
        """The errors of the page that Firefox's console has."""
        return self.in_firefox(ERRORS)

    def evaluate(self, expression):
        """Return the value of a JavaScript expression in the page."""
        script = f"return (async () => ({expression}))();"
        return self.ask("WebDriver:ExecuteScript", script=script, args=[], sandbox=None)["value"]

    wait = Browser.wait

    def screenshot(self, full=False):
        """Return a PNG of what is seen of the page, or of all of it."""
        return base64.b64decode(self.ask("WebDriver:TakeScreenshot", full=full, hash=False)["value"])

    def printed(self):
        """Return the page as a PDF."""
        return base64.b64decode(self.ask("WebDriver:Print", background=False)["value"])
