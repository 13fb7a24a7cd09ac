"""What pyproject.toml cannot say: the version is the installed library's, the extension is for every Python from 3.11."""
import sys
from pathlib import Path

from setuptools import setup

sys.path.insert(0, str(Path(__file__).parent))
import granperi_build  # noqa: E402

setup(
    version=granperi_build.pkg_config("--modversion"),
    cffi_modules=["granperi_build.py:ffibuilder"],
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
