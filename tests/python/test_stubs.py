"""The stubs and the list of public names say what the compiled modules hold."""

import ast
import typing
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
import skinglow._core as core
from skinglow import _results
from skinglow._rays_loader import load_rays
from skinglow._renamed import renamed_keywords

PACKAGE = Path(__file__).parents[2] / "python_bindings" / "skinglow"
#: The types of methods that pybind11 makes.
METHODS = ("instancemethod", "staticmethod")
SPECIAL = {"__init__", "__len__", "__eq__"}  # the special methods that a type checker looks at


def is_public(name: str) -> bool:
    return not name.startswith("_")


@cache
def definitions(tree: ast.Module | ast.ClassDef) -> dict[str, list[ast.AST]]:
    """What a module or a class defines by name, its imports left out; more than one for overloads."""
    found: dict[str, list[ast.AST]] = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.setdefault(node.name, []).append(node)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found.setdefault(node.target.id, []).append(node)
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                found.setdefault(target.id, []).append(node)
    return found


@cache
def stub(name: str) -> ast.Module:
    return ast.parse((PACKAGE / f"{name}.pyi").read_text(encoding="utf-8"))


def bound_signature(function: object) -> ast.FunctionDef:
    """The first line of what pybind11 says of a function, as Python's own parser reads it."""
    (tree,) = ast.parse(f"def {function.__doc__.splitlines()[0]}: ...").body
    return tree


def parameters(function: ast.FunctionDef) -> list[tuple[str, str, object]]:
    """(name, kind, default) of each parameter but self; "required" where there is no default."""
    given = function.args
    places = [*given.posonlyargs, *given.args]
    defaults = [None] * (len(places) - len(given.defaults)) + given.defaults
    listed = [(a.arg, "place", d) for a, d in zip(places, defaults, strict=True) if a.arg != "self"]
    listed += [(a.arg, "name", d) for a, d in zip(given.kwonlyargs, given.kw_defaults, strict=True)]
    listed += [(a.arg, "rest", None) for a in (given.vararg, given.kwarg) if a]
    return [(name, kind, "required" if d is None else ast.literal_eval(d)) for name, kind, d in listed]


def public_classes() -> list[str]:
    return [name for name, value in vars(core).items() if is_public(name) and isinstance(value, type)]


def bound_functions() -> list[str]:
    """Functions by name and methods as Class.method, those that pybind11 wrote a signature for."""
    names = [name for name, value in vars(core).items() if is_public(name) and type(value) is type(len)]
    for owner in public_classes():
        names += [
            f"{owner}.{name}"
            for name, value in vars(getattr(core, owner)).items()
            if (is_public(name) or name == "__init__") and type(value).__name__ in METHODS
        ]
    return sorted(names)


def bound(name: str) -> object:
    owner, _, method = name.rpartition(".")
    return getattr(getattr(core, owner), method) if owner else getattr(core, method)


def stubbed(name: str) -> list[ast.FunctionDef]:
    owner, _, method = name.rpartition(".")
    scope = definitions(stub("_core"))
    return (definitions(scope[owner][0]) if owner else scope)[method]


def test_stub_has_the_names_of_the_module() -> None:
    in_stub = {name for name in definitions(stub("_core")) if is_public(name)}
    assert in_stub == {name for name in vars(core) if is_public(name)}
    assert "__getattr__" not in definitions(stub("_core"))  # it would allow every name


def test_package_exports_every_name_once() -> None:
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    imported = [a.name for node in tree.body if isinstance(node, ast.ImportFrom) for a in node.names]
    imported.remove("register")  # called there
    imported.remove("__getattr__")  # gives the former names; exported, it would give them to other modules as well
    (exported,) = definitions(tree)["__all__"]
    public = {name for name in vars(core) if is_public(name)} | {
        "__version__",
        "ThicknessImage",
        "ThicknessReport",
        "ThicknessSummary",
        "bake_thickness",
        "diffuse_radiance",
        "gray_png",
        "irradiance_difference",
        "is_mirrored",
        "light_rotation",
        "luminance",
        "stratified_indices",
        "sample_image",
        "thickness",
        "thickness_colors",
        "thickness_report",
        "thickness_summary",
        "Occluders",
        "near_thin_skin",
        "VisibleFraction",
        "LitShape",
        "Shape",
        "ShapePart",
        "uniform_scale",
        "visible_entries",
    }
    assert sorted(imported) == sorted(ast.literal_eval(exported.value)) == sorted(public)


@pytest.mark.parametrize("name", public_classes())
def test_stub_has_the_members_of_the_class(name: str) -> None:
    members = vars(getattr(core, name))
    made = {
        key: value
        for key, value in members.items()
        if type(value).__name__ in (*METHODS, "property") or isinstance(value, int)
    }
    in_stub = definitions(*definitions(stub("_core"))[name])
    assert {key for key in in_stub if is_public(key) or key in SPECIAL} == {
        key for key in made if is_public(key) or key in SPECIAL
    }
    for key, value in made.items():
        if isinstance(value, property):
            (node,) = in_stub[key]
            settable = isinstance(node, ast.AnnAssign)
            assert settable == (value.fset is not None), key
            assert settable or [d.id for d in node.decorator_list] == ["property"], key


@pytest.mark.parametrize("name", bound_functions())
def test_stub_has_the_parameters_of_the_function(name: str) -> None:
    wanted = parameters(bound_signature(bound(name)))
    if wanted == [("kwargs", "rest", "required")]:  # of a Tissue: any of its parameters, by name
        start = name == "Tissue.__init__"
        wanted = [(key, "name", entry[0] if start else ...) for key, entry in core.TISSUE_PARAMETERS.items()]
    for node in stubbed(name):
        assert parameters(node) == wanted


@pytest.mark.parametrize("name", bound_functions())
def test_stub_has_a_type_for_everything(name: str) -> None:
    for node in stubbed(name):
        arguments = [*node.args.args, *node.args.kwonlyargs]
        assert all(argument.annotation for argument in arguments if argument.arg != "self")
        assert node.returns


@pytest.mark.parametrize("name", [n for n in bound_functions() if not n.endswith("__init__")] + public_classes())
def test_everything_public_says_what_it_does(name: str) -> None:
    text = bound(name).__doc__ or ""
    if name not in public_classes():
        text = "\n".join(text.splitlines()[1:])  # the first line is the signature
    assert text.strip()


def test_stub_of_the_rays_is_that_of_the_module() -> None:
    rays = load_rays()
    in_stub = definitions(stub("_rays"))
    assert set(in_stub) == {name for name in vars(rays) if is_public(name)}
    (function,) = in_stub["thickness_report"]
    assert parameters(function) == parameters(bound_signature(rays.thickness_report))
    assert issubclass(rays.ThicknessCancelled, RuntimeError)
    assert issubclass(rays.ShapeCancelled, RuntimeError)
    for name in ("Occluders", "Shape", "LitShape"):
        (owner,) = in_stub[name]
        methods = definitions(owner)
        module_class = getattr(rays, name)
        made = {
            key: value
            for key, value in vars(module_class).items()
            if (is_public(key) or key in SPECIAL) and type(value).__name__ in (*METHODS, "property")
        }
        assert set(methods) == {key for key in made if key != "__eq__"}
        for key, value in made.items():
            if type(value).__name__ in METHODS and key != "__len__":
                assert parameters(methods[key][0]) == parameters(bound_signature(value)), key


@pytest.mark.parametrize(
    ("made", "described"),
    [
        (lambda: core.light_report([core.Light()], (0, 0, 1))[0], _results.LightReportEntry),
        (lambda: core.PreparedRig([core.Light(power=0.0)]).cull((0, 0, 1), (1, 1, 2), 0.0), _results.CullingResult),
        (
            lambda: core.PreparedRig([core.Light(power=0.0)]).cull((0, 0, 1), (1, 1, 2), 0.0)["dropped"][0],
            _results.DroppedLights,
        ),
        (lambda: core.directional_transmittance([core.Layer(1.0, 1.0, 0.0)]), _results.DirectionalTransmittance),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_dictionaries_are_as_described(made: Callable[[], dict], described: type) -> None:
    assert set(made()) == set(described.__annotations__)


def test_a_function_with_former_keywords_keeps_its_type():
    """To type checkers `thickness` was Any: neither its arguments nor its result were checked."""
    ((given,), returned) = typing.get_args(typing.get_type_hints(renamed_keywords)["return"])
    assert isinstance(given, typing.TypeVar) and given is returned
