#!/usr/bin/env python3
"""The runner of the guide's code blocks fails where a block is wrong, and leaves none out in silence."""

import os
import subprocess
import sys
import tempfile

RUNNER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_blocks.py")
GOOD = """# Page
```sh
echo "made 3 things"
```
<!-- block: output -->
```text
made ... things
```
<!-- block: file deep/name.txt -->
```toml
a = 1
```
```sh
grep -q 'a = 1' deep/name.txt
```
```python
x = 2
```
```python
print(x + 1)
```
<!-- block: output -->
```text
3
```
<!-- block: fails KeyError -->
```python
{}["a"]
```
<!-- block: skip it would install something -->
```sh
false
```
"""
# (what is put in place of what, what the runner says)
BAD = [
    ("made 3 things", "made nothing", "FAILED"),
    ("print(x + 1)", "print(y)", "NameError"),
    ("print(x + 1)", "print(x + 2)", "FAILED"),
    ("grep -q 'a = 1'", "grep -q 'a = 2'", "FAILED"),
    ('{}["a"]', "{}", "FAILED"),
    ("KeyError", "TypeError", "FAILED"),
    ("<!-- block: file deep/name.txt -->\n", "", "nothing is known to do with toml"),
    ("block: skip", "block: jump", "unknown directive"),
    ("<!-- block: skip it would install something -->\n", "", "FAILED"),
    ("false\n```", "false", "has no end"),
    ("-->\n```toml", "-->\nwords\n```toml", "no block behind"),
]


def run(text):
    with tempfile.TemporaryDirectory() as work:
        page = os.path.join(work, "page.md")
        with open(page, "w") as target:
            target.write(text)
        result = subprocess.run([sys.executable, RUNNER, page], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                universal_newlines=True)
    return result.returncode, result.stdout


def main():
    code, said = run(GOOD)
    if code != 0:
        sys.exit("FAILED: the good page\n" + said)
    for old, new, expected in BAD:
        assert old in GOOD
        code, said = run(GOOD.replace(old, new))
        if code == 0 or expected not in said:
            sys.exit("FAILED: %r for %r: %d\n%s" % (new, old, code, said))
    print("passed:", len(BAD), "wrong pages are found out")


if __name__ == "__main__":
    main()
