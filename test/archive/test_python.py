"""The Python of Ubuntu 20.04, which is 3.8: neither its grammar nor its library has what came later."""
import ast
import os
import re
import signal
import subprocess
import sys

import pytest
from archive import programs
from conftest import ROOT

NEWER = {"waitstatus_to_exitcode", "removeprefix", "removesuffix", "pairwise", "is_relative_to", "readlink", "with_stem", "hardlink_to", "unparse", "lcm", "nextafter",
         "randbytes", "bit_count", "to_thread", "file_digest", "StrEnum", "zoneinfo", "tomllib", "graphlib", "BooleanOptionalAction", "sliding_window_view"}
NEWER_OF = {("functools", "cache"), ("ElementTree", "indent"), ("contextlib", "chdir"), ("datetime", "UTC")}
NEWER_OPTIONS = {("zip", "strict"), ("glob", "root_dir"), ("TemporaryDirectory", "ignore_cleanup_errors"), ("dataclass", "slots"), ("dataclass", "kw_only"),
                 ("write_text", "newline"), ("percentile", "method"), ("quantile", "method")}
GENERIC = {"list", "dict", "tuple", "set", "frozenset", "type"}  # list[int] is evaluated where it stands


def sources():
    for folder in ("scripts", "bench", "workflow", "test"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and (path.suffix == ".py" or (not path.suffix and b"python" in path.open("rb").readline())):
                yield path


def name_of(node):
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def newer(text):
    """What Python 3.8 does not have, each with its line."""
    try:
        tree = ast.parse(text, feature_version=(3, 8))
    except SyntaxError as error:
        return [f"{error.lineno}: {error.msg}"]
    found = [f"{k}: with (" for k, line in enumerate(text.splitlines(), 1) if re.match(r"\s*(async )?with \($", line)]
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and (node.attr in NEWER or (name_of(node.value), node.attr) in NEWER_OF):
            found.append(f"{node.lineno}: {node.attr}")
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            of = (getattr(node, "module", None) or "").rpartition(".")[2]
            found += [f"{node.lineno}: {alias.name}" for alias in node.names if alias.name in NEWER or of in NEWER or (of, alias.name) in NEWER_OF]
        elif isinstance(node, ast.Call):
            found += [f"{node.lineno}: {option.arg}=" for option in node.keywords if (name_of(node.func), option.arg) in NEWER_OPTIONS]
        elif isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id in GENERIC:
            found.append(f"{node.lineno}: {node.value.id}[...]")
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr) and any(isinstance(side, ast.Dict) for side in (node.left, node.right)):
            found.append(f"{node.lineno}: dict | dict")
    return found


def test_the_sources_keep_to_python_3_8():
    read = list(sources())
    assert len(read) > 40
    assert [f"{path}:{what}" for path in read for what in newer(path.read_text(encoding="utf-8"))] == []


@pytest.mark.parametrize("text", ["import os\nos.waitstatus_to_exitcode(0)\n", "'a'.removeprefix('b')\n", "match x:\n    case 1: pass\n", "zip(a, b, strict=True)\n",
                                  "def f(a: list[int]): pass\n", "x = {} | a\n", "from functools import cache\n", "import tomllib\n",
                                  "with (\n        open('a') as a, open('b') as b):\n    pass\n"])
def test_what_is_newer_is_found(text):
    assert newer(text)


def test_exit_status_is_that_of_subprocess():
    for code, expected in (("raise SystemExit(0)", 0), ("raise SystemExit(3)", 3), (f"import os; os.kill(os.getpid(), {int(signal.SIGKILL)})", -signal.SIGKILL)):
        process = subprocess.Popen([sys.executable, "-c", code])
        _, status, _ = os.wait4(process.pid, 0)
        process.returncode = programs.exit_status(status)
        assert process.returncode == expected == process.wait()
