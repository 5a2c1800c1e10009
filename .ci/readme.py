"""Run every command of the README's worked example, in order, in a folder of its own."""

import re
import shlex
import subprocess
import sys
from pathlib import Path


def main() -> int:
    folder = Path(sys.argv[1])
    folder.mkdir()
    text = Path("README.md").read_text(encoding="utf-8")
    commands = [
        line
        for block in re.findall(r"```sh\n(.*?)```", text, flags=re.DOTALL)
        for line in block.splitlines()
        if line.startswith("cable-ident ")
    ]
    if not commands:
        sys.stderr.write("README.md has no commands\n")
        return 1
    for line in commands:
        sys.stderr.write(f"$ {line}\n")
        if subprocess.run(shlex.split(line.split("#")[0]), cwd=folder, check=False).returncode:
            sys.stderr.write("failed\n")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
