"""What is written below a class's fields, for those who document or generate from them."""

import ast
import inspect
from textwrap import dedent


def field_docstrings(kind: type) -> dict[str, str]:
    """Return the strings that follow a class's fields in its source; Python itself keeps none of them."""
    (tree,) = ast.parse(dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    found, name = {}, ""
    for node in tree.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            name = node.target.id
        elif name and isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            found[name], name = " ".join(str(node.value.value).split()), ""
        else:
            name = ""
    return found
