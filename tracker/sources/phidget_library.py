"""The Phidget22 library, and the libusb that it needs and does not bring."""

import ctypes
import sys

import libusb_package

from tracker.errors import InputError

_LIBUSB = "libusb-1.0.so.0"


def load_libusb() -> str:
    """Load libusb for the library's first call to find: the system's, else the one of PyPI's `libusb-package`.

    libphidget22.so asks for the name libusb-1.0.so.0 and takes a library of that name that is loaded already. Only on Linux:
    elsewhere it speaks to the system itself.

    Returns:
        Where it came from: `the system`, or `libusb-package`.

    Raises:
        InputError: There is none.
    """
    if sys.platform != "linux":
        return "the system"
    try:
        ctypes.CDLL(_LIBUSB, mode=ctypes.RTLD_GLOBAL)
        return "the system"
    except OSError:
        pass
    path = libusb_package.get_library_path()
    if path is None:
        raise InputError("There is no libusb for the Phidgets: install libusb-1.0-0.")
    ctypes.CDLL(str(path), mode=ctypes.RTLD_GLOBAL)
    return "libusb-package"
