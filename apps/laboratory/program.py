"""Runs the command line."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from typing import Any

from .store import LabError

_ON_DEVICE = {"bake", "bench"}  # commands that take --device


class Program:
    """The program `relume`: $RELUME_PROGRAM, or what PATH has."""

    def __init__(self, device: str = "") -> None:
        self.path = os.environ.get("RELUME_PROGRAM") or shutil.which("relume") or ""
        if not self.path:
            raise LabError("relume: the program is not on PATH; install it, or name it by RELUME_PROGRAM")
        self.device = device

    def run(self, *arguments: Any) -> str:
        """What a command writes to stdout. Its stderr, with its progress, is passed on."""
        command = [self.path, *map(str, arguments)]
        if self.device and arguments[0] in _ON_DEVICE:
            command += ["--device", self.device]
        with (tempfile.TemporaryFile("w+", encoding="utf-8") as output,
              subprocess.Popen(command, stdout=output, stderr=subprocess.PIPE, text=True, errors="replace") as process):
            message = ""
            try:
                for line in process.stderr:
                    sys.stderr.write(line)
                    message = line.strip() or message
                process.wait()
            except BaseException:
                # Bakes end with what is done. A terminal's Ctrl-C reaches them too; a second signal ends them at once.
                try:
                    process.communicate(timeout=10)
                except subprocess.TimeoutExpired:
                    process.send_signal(signal.SIGINT)
                    process.communicate()
                raise
            if process.returncode in (130, 143):
                raise KeyboardInterrupt
            if process.returncode != 0:
                raise LabError(f"relume {' '.join(command[1:])}: exit code {process.returncode}: {message}")
            output.seek(0)
            return output.read()

    def json(self, *arguments: Any) -> Any:
        return json.loads(self.run(*arguments, "--json"))
