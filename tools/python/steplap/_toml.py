"""Converts Python values to TOML."""
import json
from typing import Any

_DEEPEST = 32  # deepest nesting of lists and tables; model files need four levels


def toml(value: Any, where: str, depth: int = 0) -> str:
    """Returns a value as one line of TOML. `where` names it in messages. Raises TypeError."""
    if depth > _DEEPEST:
        raise TypeError(f"'{where}' is nested more than {_DEEPEST} deep, or holds itself")
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item, where, depth + 1) for item in value) + "]"
    if isinstance(value, dict):
        items = (f"{toml(str(key), where)} = {toml(item, where, depth + 1)}" for key, item in value.items())
        return "{ " + ", ".join(items) + " }"
    raise TypeError(f"'{where}' takes a number, a text such as \"12 mm\", true or false, a list or a dictionary of these")


def _is_entries(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(item, dict) for item in value)


def toml_file(model: Any) -> str:
    """Returns the text of a model file for dictionaries and lists: {"body": [{"name": "box", "mass": "2 t"}]}. Raises TypeError."""
    tables = {key: value for key, value in model.items() if isinstance(value, dict) or _is_entries(value)}
    lines = [f"{toml(str(key), key)} = {toml(value, key)}" for key, value in model.items() if key not in tables]
    for key, value in tables.items():
        for table in [value] if isinstance(value, dict) else value:
            lines += ["", ("[%s]" if isinstance(value, dict) else "[[%s]]") % toml(str(key), key)]
            lines += [f"{toml(str(name), key)} = {toml(item, f'{key}.{name}')}" for name, item in table.items()]
    return "\n".join(lines) + "\n"


def overrides(values: Any) -> list[str]:
    """Converts a dictionary to texts "path=value". Returns a list of such texts unchanged, and an empty list for None. Raises TypeError."""
    if values is None:
        return []
    if isinstance(values, str):
        raise TypeError('values: a dictionary {"path": value}, or a list of texts "path=value", not one text')
    if hasattr(values, "items"):
        return [f"{path}={toml(value, str(path))}" for path, value in values.items()]
    return [str(text) for text in values]
