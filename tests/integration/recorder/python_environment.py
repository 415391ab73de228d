"""An environment with packages of PyPI that read recordings independently of our code."""

import pathlib
import subprocess
import sys

SKIPPED = 77
PACKAGES = ["mcap", "protobuf", "zstandard", "lz4", "rosbags"]


def enter(venv: pathlib.Path):
    """Goes on in an environment that has the packages. Exits as skipped where that cannot be made."""
    python = venv / "bin" / "python"
    if pathlib.Path(sys.prefix).resolve() == venv.resolve():
        return
    has_all = [str(python), "-c", "import mcap, google.protobuf, zstandard, lz4, rosbags"]
    if not python.exists() or subprocess.run(has_all, capture_output=True, check=False).returncode != 0:
        install = [str(venv / "bin" / "pip"), "install", "--quiet", "--disable-pip-version-check", "--retries", "1", *PACKAGES]
        for step in ([sys.executable, "-m", "venv", str(venv)], install):
            made = subprocess.run(step, capture_output=True, text=True, check=False)
            if made.returncode != 0:
                reason = (made.stderr + made.stdout).strip().splitlines()[-1:]
                print("skipped: the packages of PyPI cannot be installed:", *reason)
                sys.exit(SKIPPED)
    sys.exit(subprocess.run([str(python), *sys.argv], check=False).returncode)
