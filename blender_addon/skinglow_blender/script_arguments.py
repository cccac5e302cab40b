# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks what scripts give to the public functions: a name instead of the object is refused, with the remedy."""

import inspect
import typing
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import bpy

#: What to give, by the type of a parameter; {!r} is the text that was given.
GIVE = {
    "Object": "an object: bpy.data.objects[{!r}]",
    "Material": "a material: bpy.data.materials[{!r}]",
    "Image": "an image: bpy.data.images[{!r}], or bpy.data.images.load(...) of a file",
    "Scene": "a scene: bpy.data.scenes[{!r}]",
    "Depsgraph": "bpy.context.evaluated_depsgraph_get()",
}


def check_of(function: Callable[..., Any]) -> Callable[[tuple[Any, ...], Mapping[str, Any]], None]:
    """What raises ValueError for arguments of that function that are none of Blender's where it takes one of Blender's.

    None is left to the function, and so are arguments that do not fit its parameters.
    """
    signature = inspect.signature(function)
    wanted = {name: _wanted(parameter.annotation) for name, parameter in signature.parameters.items()}

    def check(arguments: tuple[Any, ...], keywords: Mapping[str, Any]) -> None:
        try:
            given = signature.bind_partial(*arguments, **keywords).arguments
        except TypeError:
            return
        for name, value in given.items():
            kind, is_many = wanted.get(name, (None, False))
            if kind is None or value is None:
                continue
            if is_many and isinstance(value, kind):
                raise ValueError(f"{function.__name__}: {name} is one {kind.__name__}; give a list: [{value!r}]")
            # An iterator would be used up by looking at it.
            many = value if isinstance(value, list | tuple | set) else [value] if isinstance(value, str) else []
            for each in many if is_many else [value]:
                if not isinstance(each, kind):
                    raise ValueError(f"{function.__name__}: {name} is {_shown(each)}; give {_remedy(kind, each)}")

    return check


def _wanted(annotation: Any) -> tuple[type | None, bool]:  # noqa: ANN401
    """A type of Blender's that a parameter has to be, and whether it is several of them."""
    if isinstance(annotation, type) and annotation.__name__ in GIVE and issubclass(annotation, bpy.types.bpy_struct):
        return annotation, False
    parts = [part for part in typing.get_args(annotation) if part is not type(None)]
    if len(parts) != 1:
        return None, False
    kind, is_many = _wanted(parts[0])
    return kind, is_many or (kind is not None and typing.get_origin(annotation) is Iterable)


def _shown(value: Any) -> str:  # noqa: ANN401
    return f"the text {value!r}" if isinstance(value, str) else f"{value!r}, of type {type(value).__name__}"


def _remedy(kind: type, value: Any) -> str:  # noqa: ANN401
    text = GIVE[kind.__name__]
    return text.format(value) if isinstance(value, str) else text.split(":")[0]
