"""The stubs say of the native half what it holds, and everything that is public is explained."""

from __future__ import annotations

import ast
import inspect
from pathlib import Path

import pytest

import recon
from recon import _recon

STUBS = ast.parse((Path(recon.__file__).parent / "_recon.pyi").read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_a_class_has_the_members_that_its_stub_says(name: str) -> None:
    stated = {node.name for node in CLASSES[name].body if isinstance(node, ast.FunctionDef)} - {"__init__"}
    own = {member for member in vars(getattr(_recon, name)) if not member.startswith("__") or member == "__len__"}
    assert stated == own


def test_functions_take_what_their_stubs_say() -> None:
    for node in STUBS.body:
        if isinstance(node, ast.FunctionDef):
            assert [arg.arg for arg in node.args.args] == list(inspect.signature(getattr(_recon, node.name)).parameters), node.name


def test_everything_public_is_explained() -> None:
    for name in recon.__all__:
        if name != "__version__":
            assert inspect.getdoc(getattr(recon, name)), name
    for name in CLASSES:
        for member, value in vars(getattr(recon, name, object)).items():
            if not member.startswith("_") and callable(getattr(value, "__get__", None)):
                assert value.__doc__, f"{name}.{member}"


def test_the_package_says_that_it_is_typed() -> None:
    assert (Path(recon.__file__).parent / "py.typed").is_file()
