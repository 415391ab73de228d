"""What the tests of commands share that run another program and print a table."""

import contextlib
import io
import pathlib
import tempfile
import unittest


def cells(text):
    """The cells of each line of a table by its first one."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    return {line[0]: line[1:] for line in lines}


class TableCase(unittest.TestCase):
    """Set `command`, a module with main(arguments), and `stand_in`, a script in place of slammot."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "program"
        self.program.write_text(self.stand_in)
        self.program.chmod(0o755)

    def printed(self, *arguments):
        """(exit code, stdout, stderr)"""
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            code = self.command.main(["--binary", str(self.program), "--output", str(self.folder / "out"), *arguments])
        return code, out.getvalue(), errors.getvalue()
