"""The stubs say what the package has."""

import ast
import inspect
from pathlib import Path

import creepage

STUBS = ast.parse((Path(creepage.__file__).parent / "__init__.pyi").read_text())


def parameters(function):
    arguments = function.args
    names = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
    return sorted(name.arg for name in names if name is not None)


def functions(body):
    return {node.name: node for node in body if isinstance(node, ast.FunctionDef)}


def test_stubs_have_every_public_name_with_its_parameters():
    classes = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
    top = functions(STUBS.body)
    for name in creepage.__all__:
        real = getattr(creepage, name)
        if inspect.isfunction(real):
            assert parameters(top[name]) == sorted(inspect.signature(real).parameters), name
            continue
        stub = functions(classes["_Mesh" if name == "mesh" else name].body)
        kind = real if inspect.isclass(real) else type(real)
        for method, found in vars(kind).items():
            found = getattr(found, "__func__", found)
            if method.startswith("_") and method != "__call__":
                continue
            if not (inspect.isfunction(found) or isinstance(found, property)):
                continue
            assert method in stub, f"{name}.{method}"
            if inspect.isfunction(found):
                signature = sorted(inspect.signature(found).parameters)
                assert parameters(stub[method]) == signature, f"{name}.{method}"
        for method in stub:
            assert hasattr(real, method), f"{name}.{method} is in the stubs alone"


def test_every_public_name_has_a_docstring():
    for name in creepage.__all__:
        assert inspect.getdoc(getattr(creepage, name)), name


def test_the_types_of_documents_have_every_key_of_the_documents(small):
    results = ast.parse((Path(creepage.__file__).parent / "_results.pyi").read_text())
    types = {node.targets[0].id: node.value for node in results.body if isinstance(node, ast.Assign)}
    for name, document in [("Summary", small.summary), ("CheckResult", small.check())]:
        assert set(document) <= {key.value for key in types[name].args[1].keys}, name
