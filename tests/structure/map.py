#!/usr/bin/env python3
"""The map in CONTRIBUTING.md: what it names is there, each file of src/ is on it, and so is each file that its lists name."""
import fnmatch
import pathlib
import re
import sys

MOST_LINES = 40  # of the map: a screen


def names_of(row):
    """The left column of a row; files of src/ stand there without their folder and ending."""
    return re.split(r"  +", row.strip())[0].split()


def main(root):
    text = (root / "CONTRIBUTING.md").read_text(encoding="utf-8")
    begin, end = text.index("## Where things are"), text.index("## Adding something")
    block = re.findall(r"^    .*$", text[begin:end], re.M)
    rows = [line for line in block if line[4] != " "]
    files = [path.relative_to(root / "src") for path in sorted((root / "src").rglob("*")) if path.is_file()]
    missing = {str(path) for path in files}
    faults = [f"the map has {len(block)} lines, more than fit on a screen"] if len(block) > MOST_LINES else []
    for name in [name for row in rows for name in names_of(row)]:
        own = name.removeprefix("src/").rstrip("/")
        found = {str(f) for f in files if fnmatch.fnmatch(str(f.with_suffix("")), own) or own in map(str, f.parents)}
        missing -= found
        if not found and not (root / name).exists():
            faults.append(f"the map names {name}, which is not there")
    faults += [f"src/{name} is not on the map" for name in sorted(missing)]
    for name in re.findall(r"`([\w./*]+\.(?:cpp|hpp|py|c|h|f90|toml|txt))`", text[end:]):
        if "NAME" not in name and not list(root.glob(name)) and not any(root.glob(f"*/**/{name}")):
            faults.append(f"`{name}` is named, and is not there")
    print("\n".join(faults) or f"{len(files)} files of src/, {len(rows)} rows")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
