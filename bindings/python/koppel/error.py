"""What goes wrong, as the library tells it."""

import dataclasses

from . import structs


def _decoded(value):
    # A text that was cut to its field may end within a character.
    return value.decode("utf-8", errors="replace")


@dataclasses.dataclass(frozen=True)
class Finding:
    """An error, a warning or a note; line, column and length are 0 where there is no place in a file."""

    code: str  # "E0304"; explain() says more
    severity: str  # "note", "warning" or "error"
    file: str
    line: int  # from 1
    column: int  # from 1, in bytes
    length: int  # bytes that are marked
    source_line: str
    element: str  # "joint crank"
    message: str
    advice: str

    @classmethod
    def from_struct(cls, struct):
        texts = {name: _decoded(getattr(struct, name))
                 for name in ("code", "file", "source_line", "element", "message", "advice")}
        return cls(severity=structs.SEVERITIES[struct.severity], line=struct.line, column=struct.column,
                   length=struct.length, **texts)

    def __str__(self):
        place = f"{self.file}:{self.line}:{self.column}: " if self.line else f"{self.file}: " if self.file else ""
        about = f"{self.element}: " if self.element else ""
        lines = [f"{place}{self.severity}[{self.code}]: {about}{self.message}"]
        if self.line:
            lines += [f"  {self.source_line}", "  " + " " * (self.column - 1) + "^" + "~" * (self.length - 1)]
        if self.advice:
            lines.append(f"  help: {self.advice}")
        return "\n".join(lines)


class Error(Exception):
    """A function of the library failed. status: the library's status, below 0; finding: what it told, whose fields can
    be read from the error itself, too (error.code, error.line, ...); findings: all that reading a scene found."""

    def __init__(self, status, finding=None, findings=(), message=""):
        self.status = status
        self.finding = finding or Finding("", "error", "", 0, 0, 0, "", "", message, "")
        self.findings = list(findings) or [self.finding]
        super().__init__(status, self.finding)

    @classmethod
    def from_struct(cls, struct, status, findings=()):
        return cls(status, Finding.from_struct(struct), findings)

    def __getattr__(self, name):
        if name != "finding" and name in Finding.__dataclass_fields__:
            return getattr(self.finding, name)
        raise AttributeError(name)

    def explain(self):
        """What the code means, at length."""
        from .library import text
        return text("koppel_explain_code", self.code.encode()) if self.code else ""

    def __str__(self):
        if not self.code:
            return self.message
        return "\n".join(str(finding) for finding in self.findings)
