"""A headless Chromium that tests and measurements of pages talk to, by its own protocol over two pipes."""

import json
import os
import shutil
import signal
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep

BROWSER = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
FLAGS = (
    "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--enable-unsafe-swiftshader",
)  # fmt: skip
LONGEST = 60.0  # s, of a wait


class Browser:
    """A running Chromium with one page at a time; use it in a ``with`` statement."""

    def __init__(self, size=(1280, 900)):
        self.profile = TemporaryDirectory(prefix="symrot-browser-", ignore_cleanup_errors=True)
        here_in, self.out = os.pipe()
        self.into, there_out = os.pipe()
        flags = (*FLAGS, f"--window-size={size[0]},{size[1]}", f"--user-data-dir={self.profile.name}")
        program = f'exec "$0" "$@" 3<&{here_in} 4>&{there_out}'  # the browser reads from 3 and writes to 4
        self.process = subprocess.Popen(
            ["bash", "-c", program, BROWSER, *flags, "--remote-debugging-pipe", "about:blank"],
            pass_fds=(here_in, there_out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True,
        )  # fmt: skip
        os.close(here_in)
        os.close(there_out)
        self.number, self.rest, self.errors, self.session = 0, b"", [], None
        target = next(item for item in self.ask("Target.getTargets")["targetInfos"] if item["type"] == "page")
        self.session = self.ask("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Performance"):
            self.ask(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.killpg(self.process.pid, signal.SIGKILL)  # its helpers too, which would go on to write into the profile
        self.process.wait()
        os.close(self.out)
        os.close(self.into)
        self.profile.cleanup()

    def ask(self, method, **parameters):
        """Send a command, and return its result."""
        self.number += 1
        session = {"sessionId": self.session} if self.session else {}
        message = {"id": self.number, "method": method, "params": parameters} | session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.rest:
                piece = os.read(self.into, 1 << 16)
                if not piece:
                    raise RuntimeError("the browser has ended")
                self.rest += piece
            text, self.rest = self.rest.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("method") == "Runtime.exceptionThrown":
                details = answer["params"]["exceptionDetails"]
                self.errors.append(details.get("exception", {}).get("description", details["text"]))
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def open(self, path, *, dark=False, still=True, ready="window.symrot && !symrot.job && symrot.first"):
        """Open a page and wait until ``ready`` is true: its motion is computed; ``still`` asks for reduced motion."""
        features = [
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"},
        ]
        self.ask("Emulation.setEmulatedMedia", features=features)
        self.ask("Page.navigate", url=Path(path).resolve().as_uri())
        self.wait(ready)

    def evaluate(self, expression):
        """Return the value of a JavaScript expression in the page."""
        result = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["exception"]["description"])
        return result["result"].get("value")

    def wait(self, condition, longest=LONGEST):
        """Wait until a JavaScript expression is true."""
        end = monotonic() + longest
        while not self.evaluate(f"Boolean({condition})"):
            if monotonic() > end:
                raise TimeoutError(f"{condition} is not true after {longest} s; errors: {self.errors}")
            sleep(0.05)

    def metrics(self):
        """Return the browser's counters for the page, by name, such as ScriptDuration, s."""
        return {item["name"]: item["value"] for item in self.ask("Performance.getMetrics")["metrics"]}

    def processor_seconds(self):
        """Return the processor time that the browser's processes have used so far, s; needs Linux."""
        parents, ticks = {}, {}
        for folder in Path("/proc").iterdir():
            if folder.name.isdigit():
                try:
                    fields = (folder / "stat").read_text().rpartition(")")[2].split()
                except OSError:  # the process has ended
                    continue
                parents[int(folder.name)], ticks[int(folder.name)] = int(fields[1]), int(fields[11]) + int(fields[12])

        def belongs(number):
            return number == self.process.pid or (number in parents and belongs(parents[number]))

        return sum(ticks[number] for number in ticks if belongs(number)) / os.sysconf("SC_CLK_TCK")
