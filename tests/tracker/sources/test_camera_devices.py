"""The cameras that Linux knows, from a made-up /sys."""

from pathlib import Path

from tracker.sources.camera_devices import CameraDevice, camera_device, camera_devices


def plug_in(sysfs: Path, number: int, name: str, serial: str | None, index: str = "0") -> None:
    interface = sysfs / "devices" / f"usb{number}" / f"1-{number}:1.0"
    interface.mkdir(parents=True)
    if serial is not None:
        (interface.parent / "serial").write_text(serial + "\n", encoding="utf-8")
    node = sysfs / f"video{number}"
    node.mkdir()
    (node / "name").write_text(name + "\n", encoding="utf-8")
    (node / "index").write_text(index + "\n", encoding="utf-8")
    (node / "device").symlink_to(interface)


def test_cameras_come_by_number_and_metadata_nodes_are_left_out(tmp_path: Path) -> None:
    plug_in(tmp_path, 10, "Small camera", None)
    plug_in(tmp_path, 2, "HD Pro Webcam C920", "A1B2C3")
    plug_in(tmp_path, 3, "HD Pro Webcam C920", "A1B2C3", index="1")
    assert camera_devices(tmp_path) == (
        CameraDevice(2, "HD Pro Webcam C920", "A1B2C3"),
        CameraDevice(10, "Small camera", ""),
    )
    assert camera_device(3, tmp_path) is None
    assert camera_device(99, tmp_path) is None
    assert camera_devices(tmp_path / "none") == ()
