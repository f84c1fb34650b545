"""How fast `symrot show` writes a page, and how fast a browser shows and plays it; three figures and their parts.

    python -m tests.campaigns.viewer.speed_of_page [SCENE] [SECONDS]

The page is opened in headless Chromium without a graphics card. Frames a second depend on what else runs on the machine;
the processor time of a frame and the number of drawn objects hardly do. A frame needs less than 1/60 s of each of two
cores if it needs less than 33 ms of processor time in all.
"""

import resource
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, sleep

from tests.viewer.browser import BROWSER, Browser

ROUNDS = 5
TRAIL = 2000  # points
FRAMES = 60
DRAW = """(() => {
    const {drawing} = symrot, gl = drawing.renderer.getContext(), pixel = new Uint8Array(4), begun = performance.now();
    for (let k = 0; k < FRAMES; ++k) {
        symrot.seek(symrot.stop*(0.2 + 0.6*k/FRAMES));
        drawing.render(true);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);      // waits until the frame is drawn
    }
    return (performance.now() - begun)/FRAMES;
})()""".replace("FRAMES", str(FRAMES))


def written(scene, path):
    """Return the least wall time and processor time, s, of a warm ``symrot show``."""
    rows = []
    for _ in range(ROUNDS):
        before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), perf_counter()
        subprocess.run(
            [sys.executable, "-m", "symrot", "show", scene, "-o", str(path)], check=True, capture_output=True
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        rows.append((perf_counter() - begun, used))
    return tuple(min(column) for column in zip(*rows, strict=True))


def main(arguments):
    scene = arguments[0] if arguments else "t_handle"
    seconds = float(arguments[1]) if len(arguments) > 1 else 5.0
    with TemporaryDirectory(prefix="symrot-") as folder:
        path = Path(folder) / "page.html"
        wall, used = written(scene, path)
        print(f"symrot show {scene}, warm: {wall:.2f} s, {used:.2f} s of processor time; at most 1.5 s")
        if BROWSER is None:
            print("the page is not measured: expected Chromium, but it is not installed")
            return 0
        with Browser() as browser:
            browser.open(path, still=True)
            paint = (
                "performance.getEntriesByType('paint').find(({name}) => name === 'first-contentful-paint').startTime"
            )
            browser.wait(f"{paint} > 0")
            first = browser.evaluate(paint)
            print(f"first paint: {first / 1000:.2f} s after the page was asked for; at most 1 s")
            points, ready = browser.evaluate("symrot.trailCount"), browser.evaluate("symrot.seconds")
            print(f"  motion computed and sampled in {ready:.2f} s; trail of {points} points")
            before = browser.processor_seconds()
            frame = browser.evaluate(DRAW)
            used = 1000 * (browser.processor_seconds() - before) / FRAMES
            calls = browser.evaluate("symrot.drawing.calls")
            print(f"a frame drawn alone: {frame:.1f} ms, {used:.1f} ms of processor time, {calls} draw calls")
            browser.evaluate("symrot.restart()")
            start, begun, frames = browser.metrics(), perf_counter(), browser.evaluate("symrot.frames")
            before = browser.processor_seconds()
            sleep(seconds)
            count, stop = browser.evaluate("symrot.frames") - frames, browser.metrics()
            rate = count / (perf_counter() - begun)
            used = 1000 * (browser.processor_seconds() - before) / max(count, 1)
            script, task = (
                1000 * (stop[name] - start[name]) / max(count, 1) for name in ("ScriptDuration", "TaskDuration")
            )
            print(f"playing: {rate:.0f} frames a second; at least 60")
            print(
                f"  a frame: {used:.1f} ms of processor time of all processes (33 on two cores for 60 frames a second),"
            )
            print(f"  {script:.1f} ms of script and {task:.1f} ms in all on the page's thread, by the clock")
            if points < TRAIL:
                print(f"  the trail has fewer than {TRAIL} points")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
