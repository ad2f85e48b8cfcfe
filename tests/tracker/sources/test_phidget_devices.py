"""Phidgets on the USB, from a made-up /sys; that the library lists them is held by tests/server/doctor/test_doctor.py."""

from pathlib import Path

from tracker.sources.phidget_devices import phidgets_on_usb


def test_phidgets_are_counted_by_their_vendor(tmp_path: Path) -> None:
    for name, vendor in (("1-1", "06c2\n"), ("1-2", "1d6b\n"), ("1-3", "06c2\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "idVendor").write_text(vendor, encoding="ascii")
    (tmp_path / "1-1:1.0").mkdir()  # an interface has no vendor
    assert phidgets_on_usb(tmp_path) == 2
    assert phidgets_on_usb(tmp_path / "none") == 0
