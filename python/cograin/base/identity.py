"""What a kept result was made with, by content, so that it is never taken for the result of something else.

An `Identity` is a flat mapping: names of settings to plain values, or to digests of what is too long to be shown. Two
of them are compared name by name, so that a refusal can say what differs.
"""

from __future__ import annotations

import functools
import hashlib
import re
import shutil
import site
import sys
import sysconfig
import tomllib
from argparse import Namespace
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType, SimpleNamespace
from typing import Any

import numpy as np

from cograin.base.vector import is_sparse

#: Settings by name: numbers and short texts as they are, everything else as a digest.
Identity = dict[str, Any]

#: Longest text that is kept as it is.
SHORT = 80

#: What stands in place of the digest of a file that is not there.
NO_FILE = "no such file"


def identity(value: Any, name: str) -> Identity:
    """What a value is made of, under this name."""
    return dict(_flat(value, name, set()))


def differing(mine: Mapping[str, Any], found: Mapping[str, Any]) -> list[str]:
    """What differs, in words: ``exchange.limit (60, found 30)``."""
    names = dict.fromkeys([*mine, *found])
    other = [name for name in names if name not in mine or name not in found or _differ(mine[name], found[name])]
    # Parts of what is another thing altogether say nothing more.
    whole = [name for name in other if not any(name.startswith((f"{one}.", f"{one}[")) for one in other)]
    return [_told(name, mine, found) for name in whole]


def _told(name: str, mine: Mapping[str, Any], found: Mapping[str, Any]) -> str:
    """A difference in words; digests say nothing and are left out."""
    here, there = (_shown(each.get(name, "none")) for each in (mine, found))
    return f"{name} ({here}, found {there})" if here and there else name


def _shown(value: Any) -> str:
    """A plain value as text; nothing for a digest."""
    return "" if isinstance(value, str) and value.startswith("sha256:") else str(value)


def _differ(one: Any, other: Any) -> bool:
    """Whether two plain values differ; a number that is none is the same as itself."""
    return bool(type(one) is not type(other) or (one != other and not (one != one and other != other)))


def digest(data: bytes) -> str:
    """What stands for data that are too long to be kept."""
    return f"sha256:{hashlib.sha256(data).hexdigest()[:32]}"


def of_file(path: str | Path) -> str:
    """The digest of a file, read once as long as it does not change."""
    try:
        stands = Path(path).stat()
        return _of_content(str(Path(path).resolve()), stands.st_mtime_ns, stands.st_size, stands.st_ino)
    except (OSError, ValueError):
        return NO_FILE


@functools.lru_cache(maxsize=4096)
def _of_content(path: str, _time: int, _size: int, _node: int) -> str:
    """The digest of a file of this name, age and size."""
    with open(path, "rb") as file:
        return f"sha256:{hashlib.file_digest(file, 'sha256').hexdigest()[:32]}"


def of_program(path: str | Path) -> str:
    """The digest of a command, found as a shell finds it."""
    return of_file(shutil.which(str(path)) or path)


def of_scene(path: str | Path) -> Identity:
    """A scene by its text and by every file that it names."""
    path = Path(path)
    found: Identity = {"scene": of_file(path)}
    if found["scene"] != NO_FILE:
        found.update(of_words(_texts_of(str(path.resolve()), found["scene"]), [path.parent]))
    return found


@functools.lru_cache(maxsize=256)
def _texts_of(path: str, _digest: str) -> tuple[str, ...]:
    """All texts of a scene; none of one that cannot be read, which the program says itself."""
    try:
        return tuple(_texts(tomllib.loads(Path(path).read_text(encoding="utf-8"))))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError):
        return ()


def _texts(value: Any) -> Iterator[str]:
    """Texts in tables and lists."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for each in value.values():
            yield from _texts(each)
    elif isinstance(value, list):
        for each in value:
            yield from _texts(each)


def of_words(words: Iterable[str], folders: Iterable[str | Path]) -> Identity:
    """Files that words name, each from any of these folders: whole words, what is behind ``=``, what is in quotes."""
    found: Identity = {}
    places = [Path(folder) for folder in folders]
    for word in words:
        behind = word.partition("=")[2].strip()
        quoted = [one or other for one, other in re.findall(r"\"([^\"]+)\"|'([^']+)'", word)]
        for text in dict.fromkeys([word, behind, *quoted]):
            for place in places:
                if text and len(text) < 4096 and _is_file(place / text):
                    found[f"file {text}"] = of_file(place / text)
    return found


def _is_file(path: Path) -> bool:
    """Whether a file of this name is there; some texts are no names."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


# Values of Python


def _flat(value: Any, name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """Names and plain values of what a value is made of."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | float):
        yield name, value
    elif isinstance(value, complex | bytes):
        yield name, digest(repr(value).encode())
    elif isinstance(value, str):
        yield name, value if len(value) <= SHORT else digest(value.encode(errors="surrogatepass"))
    elif isinstance(value, Path):
        yield name, of_file(value) if _is_file(value) else str(value)
    elif isinstance(value, np.ndarray):
        yield name, _array(value)
    elif id(value) not in seen:
        yield from _composed(value, name, seen | {id(value)})


def _composed(value: Any, name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """Names and plain values of what has parts."""
    if isinstance(value, Mapping):
        yield name, f"{len(value)} entries"
        for key in sorted(value, key=str):
            yield from _flat(value[key], f"{name}.{key}", seen)
    elif isinstance(value, list | tuple):
        yield from _sequence(value, name, seen)
    elif isinstance(value, set | frozenset):
        yield from _sequence(sorted(value, key=repr), name, seen)
    elif is_sparse(value):
        columns = value.tocsc()
        yield name, "×".join(map(str, columns.shape))
        for part in ("data", "indices", "indptr"):
            yield f"{name}.{part}", _array(getattr(columns, part))
    elif isinstance(value, FunctionType):
        yield from _function(value, name, seen)
    elif isinstance(value, MethodType):
        yield from _flat(value.__func__, name, seen)
        yield from _flat(value.__self__, f"{name} of", seen)
    elif isinstance(value, functools.partial):
        yield from _flat([value.func, value.args, value.keywords], name, seen)
    elif isinstance(value, Namespace | SimpleNamespace):
        yield from _attributes(vars(value), name, seen)
    elif isinstance(value, type):
        yield from _class(value, name, seen)
    elif isinstance(value, ModuleType | BuiltinFunctionType):
        yield name, getattr(value, "__qualname__", value.__name__)
    else:
        yield from _instance(value, name, seen)


def _array(values: Any) -> str:
    """An array by its shape and numbers."""
    if values.size <= 3 and values.dtype.kind in "biuf":
        return str(values.tolist())
    if values.dtype.kind == "O":
        return digest(repr(values.tolist()).encode())
    return digest(f"{values.dtype} {values.shape} ".encode() + np.ascontiguousarray(values).tobytes())


def _sequence(values: Any, name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """A list by its entries; one of many plain values by its digest."""
    if all(value is None or isinstance(value, bool | int | float | str) for value in values):
        text = str(list(values))
        yield name, text if len(text) <= SHORT else digest(text.encode(errors="surrogatepass"))
        return
    yield name, f"{len(values)} entries"
    for number, value in enumerate(values, 1):
        yield from _flat(value, f"{name}[{number}]", seen)


def _instance(value: Any, name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """An object by its class, and by its settings, or by all its attributes where it has no ``settings()``."""
    if not isinstance(value, type) and callable(getattr(value, "settings", None)):
        yield from _class(type(value), name, seen)
        yield from _attributes(value.settings(), name, seen)
        return
    if callable(getattr(value, "__wrapped__", None)):
        yield from _flat(value.__wrapped__, name, seen)
        return
    yield from _class(type(value), name, seen)
    if type(value).__module__.split(".")[0] in sys.stdlib_module_names:
        return  # locks, loggers, files: what they hold changes from process to process
    if hasattr(value, "__array__"):
        yield f"{name}.values", _array(np.asarray(value))
    else:
        yield from _attributes(getattr(value, "__dict__", {}), name, seen)


def _attributes(values: Mapping[str, Any], name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """Attributes under the names that their owner's users know."""
    for key, value in values.items():
        yield from _flat(value, f"{name}.{str(key).lstrip('_')}", seen)


def _class(kind: type, name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """A class by its name, and by its functions where it is the user's own."""
    yield name, kind.__qualname__
    for each in kind.__mro__:
        if _installed(each.__module__):
            continue
        for key, value in vars(each).items():
            function = getattr(value, "__func__", getattr(value, "fget", value))
            if isinstance(function, FunctionType):
                yield from _function(function, f"{name}.{key}", seen)


def _function(function: FunctionType, name: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """A function by its code, what it holds, and what it uses of its module; one that is installed by its name."""
    if _installed(function.__module__):
        yield name, f"{function.__module__}.{function.__qualname__}"
        return
    code = function.__code__
    yield name, digest(f"{sys.version_info[:2]} {_code(code)}".encode(errors="surrogatepass"))
    yield from _flat([function.__defaults__, function.__kwdefaults__], f"{name}.defaults", seen)
    for variable, cell in zip(code.co_freevars, function.__closure__ or (), strict=True):
        try:
            yield from _flat(cell.cell_contents, f"{name}.{variable}", seen)
        except ValueError:  # a cell that is still empty
            yield f"{name}.{variable}", None
    names = _names(code)
    for used in sorted(names & function.__globals__.keys()):
        value = function.__globals__[used]
        if isinstance(value, ModuleType):
            if getattr(value, "__file__", None) and not _installed(value.__name__):
                yield f"{name}.{used}", of_file(str(value.__file__))
        elif isinstance(value, Namespace | SimpleNamespace):
            # Of the words of a command line, those that the function uses.
            chosen = {key: each for key, each in vars(value).items() if key in names}
            yield from _attributes(chosen, f"{name}.{used}", seen)
        else:
            yield from _flat(value, f"{name}.{used}", seen)


def _code(code: CodeType) -> str:
    """The code of a function in a text that is the same in every process."""
    constants = [_constant(one) for one in code.co_consts]
    return f"{code.co_code.hex()} {constants} {code.co_names} {code.co_varnames}"


def _constant(value: Any) -> str:
    """A constant of a function; sets have no order."""
    if isinstance(value, CodeType):
        return _code(value)
    return str(sorted(map(repr, value))) if isinstance(value, frozenset) else repr(value)


def _names(code: CodeType) -> set[str]:
    """Names that a function and those within it use."""
    inner = [_names(one) for one in code.co_consts if isinstance(one, CodeType)]
    return set(code.co_names).union(*inner)


@functools.lru_cache(maxsize=1024)
def _installed(module: str) -> bool:
    """Whether a module is Python's, an installed one or this package's; anything else is the user's own."""
    if module.split(".")[0] in {"cograin", "builtins", *sys.stdlib_module_names} and module != "__main__":
        return True
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None:
        return False
    folders = [*site.getsitepackages(), site.getusersitepackages(), sysconfig.get_path("stdlib")]
    return any(Path(file).is_relative_to(folder) for folder in folders)
