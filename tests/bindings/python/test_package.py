"""What tools rely on: stubs that agree with the module, documentation on everything, a typed package."""

import ast
import inspect
import pathlib
import unittest

import weir
import weir._core
from support import SOURCE

PACKAGE = pathlib.Path(weir.__file__).parent


def stub_names():
    """Returns {"convert_files": ["source", ...], "Grid.read": [...]} from _core.pyi. Properties have None."""
    names = {}

    def add(prefix, body):
        for node in body:
            if isinstance(node, ast.ClassDef):
                add(f"{node.name}.", node.body)
            elif isinstance(node, ast.FunctionDef):
                arguments = [argument.arg for argument in node.args.args if argument.arg != "self"]
                names[prefix + node.name] = None if node.decorator_list else arguments
            elif isinstance(node, ast.AnnAssign):
                names[prefix + node.target.id] = None

    add("", ast.parse((PACKAGE / "_core.pyi").read_text()).body)
    return names


def module_names():
    """Returns the same from the module. pybind11 writes the signature into the first line of a docstring."""
    names = {}

    def add(prefix, holder):
        for name, value in vars(holder).items():
            public = not name.startswith("_") or name in ("__init__", "__version__")
            if not public or inspect.ismodule(value):
                continue
            if inspect.isclass(value):
                add(f"{name}.", value)
            elif callable(value):
                signature = value.__doc__.split("(", 1)[1].split(") ->")[0]
                words = [part.split(":")[0].strip() for part in split_arguments(signature)]
                names[prefix + name] = [word for word in words if word and word != "self"]
            elif isinstance(value, (property, str)):
                names[prefix + name] = None

    add("", weir._core)
    return names


def split_arguments(text):
    """Splits a text at the commas outside brackets."""
    depth, part = 0, ""
    for letter in text:
        depth += (letter in "[(") - (letter in "])")
        if letter == "," and depth == 0:
            yield part
            part = ""
        else:
            part += letter
    yield part


class Package(unittest.TestCase):
    def test_the_stub_has_what_the_module_has(self):
        self.assertEqual(stub_names(), module_names())

    def test_it_is_marked_as_typed(self):
        self.assertTrue((PACKAGE / "py.typed").is_file())
        for path in PACKAGE.glob("*.py"):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.FunctionDef):
                    self.assertIsNotNone(node.returns, f"{path.name}: {node.name}")

    def test_everything_is_documented(self):
        for name in weir.__all__:
            value = getattr(weir, name)
            self.assertTrue(value.__doc__, name)
            if inspect.isclass(value) and value.__module__ == "weir.grid":
                for member, content in vars(value).items():
                    if not member.startswith("_"):
                        self.assertTrue(content.__doc__, f"{name}.{member}")

    def test_every_keyword_is_explained(self):
        for keyword in inspect.signature(weir.convert).parameters:
            self.assertRegex(weir.convert.__doc__, rf"\b{keyword}\b")
        for keyword in inspect.signature(weir.Grid.render).parameters:
            if keyword != "self":
                self.assertRegex(weir.Grid.render.__doc__, rf"\b{keyword}\b")

    def test_the_version_is_the_projects(self):
        self.assertIn(f"project(weir VERSION {weir.__version__} ", (SOURCE / "CMakeLists.txt").read_text())


if __name__ == "__main__":
    unittest.main()
