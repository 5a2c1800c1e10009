"""The text of a configuration: built in, from a file, or the template. Parses nothing and needs no library."""

from dataclasses import dataclass
from pathlib import Path

from ident.schema import did_you_mean
from models.quantity import InvalidInput

_FOLDER = Path(__file__).with_name("configurations")


@dataclass(frozen=True, slots=True)
class Source:
    """A configuration before it is read: its name, where it came from, and its bytes."""

    name: str
    origin: str
    data: bytes

    @property
    def text(self) -> str:
        """The bytes as text; a byte order mark at the start is dropped."""
        try:
            return self.data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = self.data.count(b"\n", 0, error.start) + 1
            raise InvalidInput(f"{self.origin}, line {line}: not UTF-8 text; save the file as UTF-8.") from error


def builtin_names() -> tuple[str, ...]:
    """Names of the configurations that come with the program, sorted."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def builtin_text(name: str) -> str:
    """The TOML text of a built-in configuration.

    Raises
    ------
    InvalidInput
        There is no such name.
    """
    if name not in builtin_names():
        raise InvalidInput(f"There is no built-in configuration {name}{did_you_mean(name, builtin_names())}")
    return (_FOLDER / f"{name}.toml").read_bytes().decode("utf-8")


def template() -> str:
    """A commented configuration to fill in; valid as it stands."""
    return Path(__file__).with_name("template.toml").read_bytes().decode("utf-8")


def find(name_or_path: str) -> Source:
    """The configuration of a built-in name, else of a file; ``./NAME`` is always a file.

    Raises
    ------
    InvalidInput
        Neither a built-in name nor a file that can be read.
    """
    if name_or_path in builtin_names():
        return Source(name_or_path, f"built-in {name_or_path}", (_FOLDER / f"{name_or_path}.toml").read_bytes())
    path = Path(name_or_path)
    try:
        if path.is_dir():
            raise InvalidInput(f"{name_or_path} is a folder; give a configuration file or a built-in name.")
        return Source(path.stem, str(path), path.read_bytes())
    except FileNotFoundError as error:
        names = ", ".join(builtin_names())
        hint = did_you_mean(path.name, builtin_names())
        hint = hint if "did you mean" in hint else "."
        raise InvalidInput(f"{name_or_path} is neither a file nor a built-in configuration ({names}){hint}") from error
    except InvalidInput:
        raise
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        reason = getattr(error, "strerror", None) or error
        raise InvalidInput(f"{name_or_path!r} cannot be read: {reason}.") from error
