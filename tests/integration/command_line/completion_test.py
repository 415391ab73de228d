"""The completions in bash itself: words, options, files, folders and scenarios. The scripts for zsh and fish are checked for
their syntax where these shells are installed.

Usage: completion_test.py SLAMMOT
"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv.pop()).resolve()


def script(shell):
    return subprocess.run([PROGRAM, "completion", shell], check=True, capture_output=True, text=True).stdout


def completions(*words, folder="."):
    """What bash offers for the last word."""
    array = " ".join(f"'{word}'" for word in ("slammot", *words))
    code = f"{script('bash')}\nCOMP_WORDS=({array}) COMP_CWORD={len(words)}\n_slammot\nprintf '%s\\n' \"${{COMPREPLY[@]}}\"\n"
    environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "--norc", "-c", code], check=True, capture_output=True, text=True, cwd=folder, env=environment)
    assert done.stderr == "", done.stderr
    return done.stdout.split()


class Completion(unittest.TestCase):
    def test_commands(self):
        self.assertEqual(completions("ru"), ["run"])
        self.assertIn("report", completions(""))
        self.assertEqual(completions("map", ""), ["merge"])

    def test_options_of_the_command_only(self):
        self.assertEqual(completions("run", "--scen"), ["--scenario"])
        self.assertEqual(completions("check", "--scen"), [])
        self.assertIn("--output", completions("map", "merge", "--out"))

    def test_scenarios(self):
        self.assertEqual(completions("run", "--scenario", "bloc"), ["block"])

    def test_files_and_folders(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "drive.log").touch()
            (Path(folder) / "drives").mkdir()
            self.assertEqual(sorted(completions("run", "--input", "dri", folder=folder)), ["drive.log", "drives"])
            self.assertEqual(completions("run", "--output", "dri", folder=folder), ["drives"])
            self.assertEqual(sorted(completions("check", "dri", folder=folder)), ["drive.log", "drives"])

    def test_nothing_is_guessed_for_other_values(self):
        self.assertEqual(completions("run", "--seed", ""), [])

    def test_other_shells_take_their_scripts(self):
        for shell in ("zsh", "fish"):
            self.assertIn("run", script(shell))
            if shutil.which(shell):
                subprocess.run([shell, "-n"], input=script(shell), text=True, check=True)


if __name__ == "__main__":
    unittest.main()
