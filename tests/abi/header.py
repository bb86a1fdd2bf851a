"""What the ABI headers declare, read from their text: functions, structs and constants."""

import pathlib
import re

HEADERS = ("plugin.h", "koppel.h", "dynamics.h")


def _plain(text):
    """The text without comments, preprocessor lines and repeated white space."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r"^\s*#(.*\\\n)*.*$", " ", text, flags=re.M)
    return re.sub(r"\s+", " ", text)


def _tidy(declaration):
    """Spaces as clang-format sets them."""
    starred = re.sub(r"\s*(\*+)\s*", r"\1 ", re.sub(r"\* (?=\*)", "*", declaration))
    return re.sub(r"\s*\(\*\s*(\w+)\)", r" (*\1)", starred).strip()


def _split(members):
    """Splits at semicolons."""
    return [member.strip() for member in members.split(";") if member.strip()]


def _field_name(member):
    pointer = re.search(r"\(\*\s*(\w+)\)\s*\(", member)
    return pointer.group(1) if pointer else re.search(r"(\w+)\s*(\[\d+\])?$", member).group(1)


class Header:
    """In the order of the headers: functions {name: signature}, structs {name: {field: declaration}}, opaque names,
    aliases (type, name), enumerators (names), macros {name: text} with a number or a string."""

    def __init__(self, include):
        texts = [(pathlib.Path(include) / "koppel" / name).read_text(encoding="utf-8") for name in HEADERS]
        plain = " ".join(_plain(text) for text in texts)
        self.functions = {
            found.group(2): _tidy(f"{found.group(1)} {found.group(2)}({found.group(3)})")
            for found in re.finditer(r"KOPPEL_EXPORT ([\w\s*]+?) ?\b(koppel_\w+)\(([^)]*)\);", plain)
        }
        self.structs = {
            found.group(3): {_field_name(member): _tidy(member) for member in _split(found.group(2))}
            for found in re.finditer(r"typedef struct (koppel_\w+) \{([^}]*)\} (koppel_\w+);", plain)
        }
        self.opaque = re.findall(r"typedef struct (koppel_\w+) \1;", plain)
        self.aliases = re.findall(r"typedef (\w+) (koppel_\w+);", plain)
        self.enumerators = [
            re.match(r"\w+", item.strip()).group(0)
            for found in re.finditer(r"enum \{([^}]*)\}", plain)
            for item in found.group(1).split(",")
            if item.strip()
        ]
        macros = re.findall(r'^#define (KOPPEL_\w+)[ \t]+(\d+u|"[^"]*")', "\n".join(texts), flags=re.M)
        self.macros = dict(macros)
