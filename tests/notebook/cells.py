"""Runs the notebooks of ``docs/notebooks`` in this process, and writes the outputs of their cells.

    python -m tests.notebook.cells

runs all notebooks and stores their outputs. Each value at the end of a cell is shown as a notebook shows it.
"""

import ast
import base64
import contextlib
import io
import json
import tempfile
from pathlib import Path
from typing import Any

NOTEBOOKS = Path(__file__).parents[2] / "docs" / "notebooks"
LARGEST_OUTPUT = 60_000
"""Largest text of one output, in characters; a page that moves is larger, and is shown only when the cell is run."""

FORMS = {"_repr_html_": "text/html", "_repr_markdown_": "text/markdown", "_repr_latex_": "text/latex"}


def paths() -> list[Path]:
    """Return the notebooks, in alphabetical order."""
    return sorted(NOTEBOOKS.glob("*.ipynb"))


def outputs_of(path: Path) -> list[list[dict[str, Any]]]:
    """Run the code cells of a notebook in a temporary folder; return the outputs of each."""
    names: dict[str, Any] = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        return [_run("".join(cell["source"]), names) for cell in _code_cells(path)]


def _code_cells(path: Path) -> list[dict[str, Any]]:
    return [cell for cell in json.loads(path.read_text("utf-8"))["cells"] if cell["cell_type"] == "code"]


def _run(source: str, names: dict[str, Any]) -> list[dict[str, Any]]:
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, "cell", "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    outputs: list[dict[str, Any]] = []
    if printed.getvalue():
        outputs.append(
            {"output_type": "stream", "name": "stdout", "text": printed.getvalue().splitlines(keepends=True)}
        )
    if value is not None:
        data = {kind: text.splitlines(keepends=True) for kind, text in _shown(value).items()}
        outputs.append({"output_type": "execute_result", "execution_count": None, "metadata": {}, "data": data})
    return outputs


def _shown(value: Any) -> dict[str, str]:
    """Return what a notebook shows for a value, by kind of text; a figure of matplotlib is a PNG picture."""
    data = {"text/plain": repr(value)}
    for method, kind in FORMS.items():
        text = getattr(value, method)() if hasattr(value, method) else None
        if text and len(text) <= LARGEST_OUTPUT:
            data[kind] = text
    if hasattr(value, "savefig"):
        picture = io.BytesIO()
        value.savefig(picture, format="png", dpi=72, metadata={"Software": None})
        data = {"text/plain": "<Figure>", "image/png": base64.b64encode(picture.getvalue()).decode("ascii") + "\n"}
    return data


def stored(path: Path) -> list[list[dict[str, Any]]]:
    """Return the outputs that are stored in a notebook."""
    return [cell["outputs"] for cell in _code_cells(path)]


def comparable(outputs: list[list[dict[str, Any]]]) -> list[list[Any]]:
    """Return outputs without pictures, whose bytes depend on the version of matplotlib."""
    return [
        [output.get("text") or {k: v for k, v in output["data"].items() if k != "image/png"} for output in cell]
        for cell in outputs
    ]


def write(path: Path) -> None:
    """Run a notebook and store the outputs of its cells."""
    notebook, outputs = json.loads(path.read_text("utf-8")), iter(outputs_of(path))
    for number, cell in enumerate((c for c in notebook["cells"] if c["cell_type"] == "code"), start=1):
        cell["outputs"], cell["execution_count"] = next(outputs), number
        for output in cell["outputs"]:
            if output["output_type"] == "execute_result":
                output["execution_count"] = number
    path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", "utf-8")


if __name__ == "__main__":
    for each in paths():
        write(each)
        print(each.name)
