#!/usr/bin/env python3
"""Every command prints the same, but for upper and lower case.

usage: same_output.py COMMAND...    each as one argument, e.g. build/scenario_c "python3 scenario.py"
"""

import shlex
import subprocess
import sys

commands = sys.argv[1:]
if len(commands) < 2:
    sys.exit(__doc__)
texts = [subprocess.run(shlex.split(command), check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout.lower()
         for command in commands]
print(texts[0], end="")
if not texts[0].strip():
    sys.exit("FAILED: nothing was printed")
for command, text in zip(commands[1:], texts[1:]):
    if text != texts[0]:
        sys.exit("FAILED: %s printed\n%s" % (command, text))
