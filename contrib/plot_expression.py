# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas of plot.json: columns of statistics.csv in braces, numbers, + - * / **, a few functions.

    -{wedge.velocity.y [m/s]}          sqrt({a.velocity.x [m/s]}**2 + {a.velocity.y [m/s]}**2)

Nothing else is evaluated, so that a case from elsewhere can't run code.
"""
import ast
import operator
import re

import numpy as np

OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
FUNCTIONS = {
    name: getattr(np, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "abs")
}
FUNCTIONS.update(min=np.minimum, max=np.maximum)


def evaluate(text, columns, names=None):
    """The value of a formula; `columns` by their titles, `names` are further variables."""
    values = dict(names or {}, pi=np.pi)

    def column(match):
        title = match.group(1)
        if title not in columns:
            raise KeyError(f"there is no column '{title}' in statistics.csv")
        key = f"column_{len(values)}"
        values[key] = columns[title]
        return key

    def walk(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return node.value
        if isinstance(node, ast.Name) and node.id in values:
            return values[node.id]
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](walk(node.left), walk(node.right))
        if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](walk(node.operand))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in FUNCTIONS:
            return FUNCTIONS[node.func.id](*(walk(argument) for argument in node.args))
        raise ValueError(f"'{text}' can't be understood at '{ast.unparse(node)}'")

    formula = re.sub(r"\{([^}]*)\}", column, text)
    try:
        return walk(ast.parse(formula, mode="eval").body)
    except SyntaxError as error:
        raise ValueError(f"'{text}' is not a formula") from error
