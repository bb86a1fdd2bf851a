"""Where the tests find things."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SUSPENSION = ROOT / "apps" / "scenes" / "5link.toml"
