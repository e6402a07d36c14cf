"""The notebook runs from its first cell to its last, and shows the report."""

from __future__ import annotations

from pathlib import Path

import pytest

BOOK = Path(__file__).resolve().parents[1] / "examples" / "first-steps.ipynb"


def test_the_notebook_runs() -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    book = nbformat.read(BOOK, as_version=4)
    nbclient.NotebookClient(book, timeout=300, kernel_name="python3").execute()
    outputs = [output for cell in book.cells for output in cell.get("outputs", [])]
    assert any("iframe" in output.get("data", {}).get("text/html", "") for output in outputs)
    assert any("row 7" in output.get("text", "") for output in outputs)
