"""The parts of the build which are not data: the version and the library inside the wheel."""
import pathlib
import re
import shutil
import sys

from setuptools import setup
from setuptools.command.build_ext import build_ext

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import build_extension  # noqa: E402


class BuildWithLibrary(build_ext):
    """Puts the shared library beside the extension module."""

    def run(self):
        super().run()
        library = next((build_extension.build / "lib").glob("libquadcover.so.?"))
        inside = pathlib.Path(self.build_lib) / "quadcover" / library.name
        inside.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(library.resolve(), inside)


def version():
    header = (build_extension.include / "qc" / "base.h").read_text()
    return re.search(r'QC_VERSION_STRING "([^"]+)"', header).group(1)


setup(
    version=version(),
    packages=["quadcover"],
    package_data={"quadcover": ["py.typed", "*.pyi"]},
    cffi_modules=["build_extension.py:ffi"],
    cmdclass={"build_ext": BuildWithLibrary},
)
