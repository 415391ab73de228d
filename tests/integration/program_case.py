"""Tests of the commands of one program in a temporary folder."""

import pathlib
import subprocess
import tempfile
import unittest


class ProgramCase(unittest.TestCase):
    """A test file sets `slammot`, the program. `work` is a folder of the class, removed at its end."""

    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix=f"slammot-{cls.__name__.lower()}-")
        cls.work = pathlib.Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def call(cls, *arguments, code=0):
        """The finished process; an error unless it ended with `code`."""
        done = subprocess.run([cls.slammot, *map(str, arguments)], capture_output=True, text=True, timeout=240)
        if done.returncode != code:
            raise AssertionError(f"exit code {done.returncode} for {code}: {done.stdout}{done.stderr}")
        return done
