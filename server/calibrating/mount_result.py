"""What `agora calibrate rig` has found, as tables of the rig file, sentences, numbers and figures."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from server.calibrating.feed import Feed
from server.calibrating.result import Result, today
from server.plots.mount import mount_pictures
from server.plots.style import Picture
from tracker.calibrate.camera_mount import CameraMount
from tracker.calibrate.common_mount import CommonMount
from tracker.rig_file import RigFile
from tracker.rig_sheets import CameraMountSheet, CameraSheet

#: Standard errors that are good enough to be kept.
LARGEST_ROTATION_SIGMA_RAD = np.radians(0.5)
LARGEST_OFFSET_SIGMA_S = 0.005
LARGEST_FOCAL_SCATTER = 0.02
#: Share of the turning that must be across the line of sight for a focal length.
LEAST_ACROSS = 0.6

By = Literal["board", "flow"]


def mount_result(
    mount: CommonMount, free: CommonMount | None, feeds: Sequence[Feed], rig_file: RigFile, *, by: By
) -> Result:
    """Return the mount as tables and words, and the focal length of `free`, which was found with no lens known."""
    names = [feed.name for feed in feeds]
    found, doubts = _words(mount, names, by), []
    found += _against_present(mount, rig_file)
    sheets: dict[str, CameraMountSheet | CameraSheet] = {}
    doubt = _doubt_of_mount(mount)
    if doubt:
        doubts.append(doubt)
    else:
        sheets["camera_mount"] = _mount_sheet(mount, feeds, rig_file)
    if free is not None:
        found = [*_focal_words(mount, free, names), *found]
        doubt = _doubt_of_focal(free)
        if doubt:
            doubts.append(doubt)
        else:
            sheets["camera"] = _camera_sheet(free, device_of(feeds))
            found.append(
                "The lens is taken as one that does not bend; `agora calibrate camera` measures it with a board."
            )

    def pictures() -> Sequence[Picture]:
        return mount_pictures(dict(zip(_distinct(names), mount.mounts, strict=True)))

    return Result("rig", sheets, found, doubts, _numbers(mount, free, names, by), pictures)


def device_of(feeds: Sequence[Feed]) -> tuple[str, str]:
    """Return name and serial number of the camera, as all feeds say."""
    names, serials = zip(*(feed.device("camera") for feed in feeds), strict=True)
    return ", ".join(dict.fromkeys(names)), serials[0]


def _distinct(names: Sequence[str]) -> list[str]:
    """Return the names, numbered where two are the same."""
    return [f"{name} ({k + 1})" if names.count(name) > 1 else name for k, name in enumerate(names)]


def _doubt_of_mount(mount: CommonMount) -> str:
    worst = float(mount.rotation_sigmas_rad[-1])
    if worst <= LARGEST_ROTATION_SIGMA_RAD and mount.offset_sigma_s <= LARGEST_OFFSET_SIGMA_S:
        return ""
    if worst <= LARGEST_ROTATION_SIGMA_RAD and mount.offset_sigma_s > max(
        one.alignment.offset_sigma_s for one in mount.mounts
    ):
        return (
            "The mount was not kept: from recording to recording the camera's clock differs by "
            f"{mount.offset_sigma_s * 1e3:.1f} ms (5 is asked for): give one recording alone, or record again."
        )
    return (
        f"The mount was not kept: about one axis it is uncertain by {np.degrees(worst):.1f} degrees (0.5 is asked for), "
        f"and the clock by {mount.offset_sigma_s * 1e3:.1f} ms (5): pan to both sides, then nod and tilt as well, "
        "a bit faster."
    )


def _doubt_of_focal(free: CommonMount) -> str:
    focal_px, scatter = free.camera.fx_px, free.focal_scatter_px / free.camera.fx_px
    if free.across < LEAST_ACROSS:
        return (
            f"The focal length, {focal_px:.0f} px, was not kept: the rig mostly rolled about the line of sight, "
            "which hardly tells it: pan instead, or run `agora calibrate camera`."
        )
    if scatter > LARGEST_FOCAL_SCATTER:
        return (
            f"The focal length, {focal_px:.0f} px, was not kept: its turns agree only within {scatter:.1%}: "
            "pan further and longer, or run `agora calibrate camera`."
        )
    return ""


def _focal_words(mount: CommonMount, free: CommonMount, names: Sequence[str]) -> list[str]:
    stated = "" if mount is free else f"; the recording states {mount.camera.fx_px:.1f}"
    least_px, most_px = _focal_between_px(free)
    words = [
        f"Focal length {free.camera.fx_px:.1f} px by the turning alone{stated}. Its turns agree within "
        f"±{free.focal_scatter_px:.1f} px; with what no turn tells (the gyroscope's scale, a lens that bends, the camera's way "
        f"about who holds it) it is between {least_px:.0f} and {most_px:.0f} px, nineteen times of twenty."
    ]
    if len(names) > 1:
        each = ", ".join(
            f"{name} {alone.camera.fx_px:.1f} ±{alone.focal_scatter_px:.1f} px ({one.alignment.focal_share:.0%} of what is known)"
            for name, alone, one in zip(names, free.alone, free.mounts, strict=True)
        )
        agree = (
            "further apart than their errors allow, which is in the ± above"
            if free.disagrees
            else "no further apart than their turns and the camera's own way allow"
        )
        words.append(f"The recordings alone say: {each}; {agree}.")
    return words


def _words(mount: CommonMount, names: Sequence[str], by: By) -> list[str]:
    words = [
        _clock_words(mount, names),
        f"The camera's axes on the rig are known to {', '.join(f'{s:.2f}' for s in np.degrees(mount.rotation_sigmas_rad))} "
        f"degrees (best to worst axis), from {mount.turns} turns of {np.degrees(mount.turn_rad):.0f} degrees in all, "
        f"{'before the board' if by == 'board' else 'by corners that were followed'}.",
        f"What of a turn the gyroscope does not explain: {mount.residual_px:.2f} px, median.",
    ]
    if mount.rotation_apart_rad:
        words.append(
            f"The recordings disagree about the mounting by {np.degrees(mount.rotation_apart_rad):.2f} degrees, more than their "
            "errors allow: was the camera moved on the rig between them?"
        )
    if mount.readout_s:
        words.append(
            f"The camera reads its rows one after the other, in {abs(mount.readout_s) * 1e3:.0f} ms (rolling shutter)."
        )
    return words


def _clock_words(mount: CommonMount, names: Sequence[str]) -> str:
    early = [f"{abs(s) * 1e3:.1f} ms too {'early' if s > 0 else 'late'}" for s in mount.offsets_s]
    within = [f"±{one.alignment.offset_sigma_s * 1e3:.1f}" for one in mount.mounts]
    if len(names) == 1:
        return f"The camera's pictures are {early[0]} in their stamps, {within[0]}."
    each = "; ".join(map("{}, {} ({})".format, early, within, names))
    return f"In their stamps the camera's pictures are {each}."


def _against_present(mount: CommonMount, rig_file: RigFile) -> list[str]:
    """Say how far the new mount is from the one so far."""
    if rig_file.camera_mount is None:
        return []
    R = rig_file.rig().T_body_cam[:3, :3].T @ mount.R_body_cam
    angle = float(np.degrees(np.arccos(np.clip(0.5 * (np.trace(R) - 1.0), -1.0, 1.0))))
    return [f"That is {angle:.2f} degrees from the mount that was known so far."]


def _numbers(mount: CommonMount, free: CommonMount | None, names: Sequence[str], by: By) -> Mapping[str, Any]:
    focal = free or mount
    return {
        "focal_px": focal.camera.fx_px,
        "focal_sigma_px": focal.focal_sigma_px,
        "focal_between_px": _focal_between_px(focal),
        "focal_is_found": free is not None,
        "R_body_cam": mount.R_body_cam.tolist(),
        "rotation_sigma_deg": float(np.degrees(mount.rotation_sigmas_rad[-1])),
        "rotation_apart_deg": float(np.degrees(mount.rotation_apart_rad)),
        "time_offset_s": mount.offset_s,
        "time_sigma_s": mount.offset_sigma_s,
        "readout_s": mount.readout_s,
        "residual_px": mount.residual_px,
        "by": by,
        "recordings": [
            _recording(name, one, found, alone)
            for name, one, found, alone in zip(names, mount.mounts, focal.mounts, focal.alone, strict=True)
        ],
    }


def _recording(name: str, mount: CameraMount, found: CameraMount, alone: CameraMount) -> Mapping[str, Any]:
    return {
        "name": name,
        "focal_alone_px": alone.camera.fx_px,
        "focal_alone_scatter_px": alone.focal_scatter_px,
        "focal_share": found.alignment.focal_share,
        "time_offset_s": mount.alignment.offset_s,
        "time_sigma_s": mount.alignment.offset_sigma_s,
        "gyro_bias_rad_s": mount.alignment.bias_rad_s.tolist(),
        "residual_px": mount.residual_px,
        "turns": len(mount.turns.times_s),
        "turn_deg": float(np.degrees(mount.turn_rad)),
    }


def _focal_between_px(mount: CommonMount) -> tuple[float, float]:
    """Return the ends of what holds the focal length nineteen times of twenty."""
    off_px = 1.96 * mount.focal_sigma_px
    return mount.camera.fx_px - off_px, mount.camera.fx_px + off_px


def _mount_sheet(mount: CommonMount, feeds: Sequence[Feed], rig_file: RigFile) -> CameraMountSheet:
    before = rig_file.rig() if rig_file.camera_mount is not None else feeds[0].rig
    T_body_cam = np.eye(4)
    T_body_cam[:3, :3] = mount.R_body_cam
    T_body_cam[:3, 3] = before.T_body_cam[:3, 3]
    device, serial = device_of(feeds)
    return CameraMountSheet(
        date=today(),
        device=device,
        serial=serial,
        T_body_cam=tuple(tuple(row) for row in T_body_cam.tolist()),
        time_offset_s=mount.offset_s,
        rotation_sigma_rad=float(mount.rotation_sigmas_rad[-1]),
        time_sigma_s=mount.offset_sigma_s,
        residual_px=mount.residual_px,
    )


def _camera_sheet(mount: CommonMount, device: tuple[str, str]) -> CameraSheet:
    return CameraSheet.of(
        mount.camera,
        date=today(),
        device=device[0],
        serial=device[1],
        method="pan",
        rms_px=mount.residual_px,
        focal_sigma_px=mount.focal_sigma_px,
        views=mount.turns,
        coverage=1.0,
    )
