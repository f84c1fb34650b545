"""The search of a book, run by Node.js without a browser."""

import json
import shutil
import subprocess

NODE = shutil.which("node")

PAGE = """
const nothing = () => ({ items: [], append(...parts) { this.parts = parts; }, addEventListener() {},
  replaceChildren(...items) { this.items = items; } });
const typed = nothing(), results = nothing();
const document = { querySelector: () => typed, createElement: nothing,
  getElementById: (id) => id === "results" ? results : nothing() };
const location = { search: "" };
"""
ASK = """
console.log(JSON.stringify(JSON.parse(process.argv[2]).map((query) => {
  typed.value = query;
  search();
  return results.items.map((item) => item.parts[0].href.split(".")[0]);
})));
"""


def pages_of(script, *queries):
    """Return for each query the names of the pages that a book's ``search.js`` lists, the best page first."""
    done = subprocess.run([NODE, "-", json.dumps(queries)], input=PAGE + script + ASK, capture_output=True, text=True,
                          check=True)  # fmt: skip
    return [list(dict.fromkeys(names)) for names in json.loads(done.stdout)]
