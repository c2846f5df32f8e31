"""Python draws what the file says: nothing in boxwood_results computes a statistic, a ratio or who is best."""

import ast

import pytest
from synthetic import SCRIPTS

from boxwood.results.reader import DERIVED, MEASURED

MODULES = {"statistics", "scipy", "pandas", "functools", "itertools", "operator", "fractions"}
SUMS = {"sum", "fsum", "prod", "reduce", "accumulate"}
OF_NUMPY = {"median", "nanmedian", "mean", "nanmean", "average", "percentile", "nanpercentile", "quantile", "nanquantile",
            "std", "nanstd", "var", "nanvar", "sum", "nansum", "prod", "cumsum", "cumprod", "polyfit", "histogram",
            "bincount", "corrcoef", "cov", "interp", "min", "max", "amin", "amax", "nanmin", "nanmax", "argmin", "argmax",
            "argsort", "partition", "divide", "subtract", "diff", "gradient", "ptp"}
OF_ARRAYS = {"mean", "std", "var", "sum", "prod", "cumsum", "cumprod", "min", "max", "argmin", "argmax", "argsort", "ptp"}
ARITHMETIC = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Pow, ast.Mod)
COLUMNS = {column for columns in (*MEASURED.values(), *DERIVED.values()) for column in columns}
# Of the classes that hold rows: run.Cell, kernels.Kernel, moving.EffectCost, findings.Ratio, size_scaling.Fit.
MEMBERS = {"ns", "wrong", "maybe", "error", "per_million", "unexcluded", "tiers", "mid", "lo", "hi", "gain", "with_ns",
           "without_ns", "extra_ns", "times_fastest", "noise_floor", "n", "n_queries", "counters", "frame_stats", "work"}
LAYOUT = {"labels.py", "style.py"}  # where texts and axes stand; they know no result file
CHECKS = {"recomputed.py", "rederived.py", "verdicts.py"}  # hold what a file says against its samples, and show nothing
COMPUTES = {"python_times.py", "dropin_times.py"}  # of samples that no result file holds
MEANS = {"marks.py"}  # of ratios that no one result file holds together
ALLOWED = {
    ("figures/builder_tradeoff.py", "draw_panel"): "where the number beside a line stands",
    ("figures/ledger.py", "height_of"): "inches that bars and their text take",
    ("figures/ledger.py", "draw"): "inches of the panels",
    ("figures/effect_cost.py", "draw"): "inches of the rows",
    ("figures/forest.py", "draw_one"): "inches of the rows",
    ("figures/frame_times.py", "draw_all"): "inches of the panels",
}


def parts_of(node):
    """As ast.walk, but how many there are is no value of theirs."""
    yield node
    if not (isinstance(node, ast.Call) and getattr(node.func, "id", "") == "len"):
        for child in ast.iter_child_nodes(node):
            yield from parts_of(child)


def is_measured(node, names):
    """Whether an expression holds what was read from a result file."""
    for part in parts_of(node):
        if isinstance(part, ast.Name) and part.id in names:
            return True
        if isinstance(part, ast.Attribute) and part.attr in MEMBERS:
            return True
        if isinstance(part, ast.Subscript) and isinstance(part.slice, ast.Constant) and part.slice.value in COLUMNS:
            return True
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Attribute) and part.func.attr == "median":
            return True
    return False


def measured_names(function):
    """Names of a function that stand for what was read."""
    names = set()
    while True:
        bound = set()
        for node in ast.walk(function):
            if isinstance(node, ast.Assign):
                pairs = [(target, node.value) for target in node.targets]
            elif isinstance(node, (ast.For, ast.comprehension)):
                pairs = [(node.target, node.iter)]
            elif isinstance(node, (ast.AugAssign, ast.NamedExpr)):
                pairs = [(node.target, node.value)]
            else:
                continue
            for target, value in pairs:
                if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
                    parts = zip(target.elts, value.elts)
                else:
                    parts = [(target, value)]
                bound |= {name.id for one, of in parts if is_measured(of, names)
                          for name in ast.walk(one) if isinstance(name, ast.Name)}
        if bound <= names:
            return names
        names |= bound


def breaches_of(function):
    names = measured_names(function)
    for node in ast.walk(function):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ARITHMETIC):
            if is_measured(node.left, names) and is_measured(node.right, names):
                yield node, "arithmetic on two values of the file"
        elif isinstance(node, ast.Subscript) and isinstance(node.value, ast.Call):
            if getattr(node.value.func, "id", "") == "sorted" and not isinstance(node.slice, ast.Slice):
                yield node, "a place in an order"
        elif isinstance(node, ast.Call):
            called = getattr(node.func, "id", "") or getattr(node.func, "attr", "")
            base = getattr(getattr(node.func, "value", None), "id", "")
            if called in SUMS or (base in ("np", "numpy") and called in OF_NUMPY):
                yield node, called
            elif isinstance(node.func, ast.Attribute) and called in OF_ARRAYS:
                yield node, called
            elif called in ("min", "max") and any(keyword.arg == "key" for keyword in node.keywords):
                yield node, f"{called} by a key, which decides who is best"


def breaches(name, text):
    """["name:line function: what"] of one module."""
    tree = ast.parse(text)
    found = []
    for node in ast.walk(tree):
        imported = [alias.name for alias in node.names] if isinstance(node, ast.Import) else (
            [node.module] if isinstance(node, ast.ImportFrom) and not node.level else [])
        found += [f"{name}:{node.lineno}: import of {module}" for module in imported if module.split(".")[0] in MODULES]
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    inner = {id(part) for one in functions for part in ast.walk(one) if part is not one}
    outside = ast.Module([node for node in tree.body if not isinstance(node, (ast.FunctionDef, ast.ClassDef))], [])
    for function in [one for one in functions if id(one) not in inner] + [outside]:
        at = getattr(function, "name", "")
        if (name, at) not in ALLOWED:
            found += [f"{name}:{node.lineno}: {at}: {what}" for node, what in breaches_of(function)]
    return found


PACKAGE = SCRIPTS / "boxwood_results"
FILES = {str(file.relative_to(PACKAGE)): file.read_text() for file in sorted(PACKAGE.rglob("*.py"))}


@pytest.mark.parametrize("name", [name for name in FILES if name not in LAYOUT | CHECKS | COMPUTES | MEANS])
def test_no_statistics(name):
    assert breaches(name, FILES[name]) == []


def test_what_is_allowed_is_needed():
    """A function that no longer computes anything leaves the list."""
    for name, function in ALLOWED:
        (found,) = [node for node in ast.walk(ast.parse(FILES[name]))
                    if isinstance(node, ast.FunctionDef) and node.name == function]
        assert list(breaches_of(found)), (name, function)
    for name in LAYOUT:
        assert "reader" not in FILES[name] and "source[" not in FILES[name]


@pytest.mark.parametrize(
    "planted",
    [
        "from statistics import median",
        "import scipy.stats",
        "def f(times):\n    return sum(times) / len(times)",
        "def f(times):\n    return np.percentile(times, 95)",
        "def f(row):\n    return row['median_ns'] / row['limit_ns']",
        "def f(cell, other):\n    return cell.median('query') / other.median('query')",
        "def f(cell, cells):\n    fastest = cells[0].median('query')\n    return [c.median('query') / fastest for c in cells]",
        "def f(kernel):\n    return 1e6 * kernel.wrong / kernel.n",
        "def f(cells):\n    return min(cells, key=lambda c: c.median('query'))",
        "def f(times):\n    return sorted(times)[len(times) // 2]",
        "def f(array):\n    return array.mean()",
        "class A:\n    def f(self):\n        total, n = self.row['false_pos'], self.row['n']\n        return total / n",
        "def f(frames):\n    a = [row['query_ns'] for row in frames]\n    return [x / y for x, y in zip(a, a)]",
        "worst = max(rows, key=abs)",
    ],
)
def test_a_planted_statistic_is_found(planted):
    assert breaches("figures/planted.py", planted)
    assert breaches("figures/accuracy.py", FILES["figures/accuracy.py"] + "\n\n" + planted + "\n")
