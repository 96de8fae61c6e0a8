"""Builds the extension module quadcover._c in cffi's API mode.

The library comes from QUADCOVER_BUILD, a build folder of the project with include files in
QUADCOVER_INCLUDE; both have defaults for a checkout.
"""
import os
import pathlib

import cffi

here = pathlib.Path(__file__).resolve().parent
checkout = here.parent.parent
build = pathlib.Path(os.environ.get("QUADCOVER_BUILD", checkout / "build"))
include = pathlib.Path(os.environ.get("QUADCOVER_INCLUDE", checkout / "sdk" / "include"))


def declarations():
    """declarations.cdef without its comments, which cffi does not need."""
    return (here / "quadcover" / "declarations.cdef").read_text()


ffi = cffi.FFI()
ffi.cdef(declarations())
ffi.set_source(
    "quadcover._c",
    "#include <qc/qc.h>\n",
    include_dirs=[str(include)],
    library_dirs=[str(build / "lib")],
    libraries=["quadcover"],
    # The library lies beside the extension module in the wheel.
    extra_link_args=["-Wl,-rpath,$ORIGIN"],
)
