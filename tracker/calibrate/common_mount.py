"""Several recordings of one rig as one calibration: the same rotation and focal length, each recording with clocks of its own."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker import rotations
from tracker.calibrate.alignment import align_all
from tracker.calibrate.camera_mount import OWN_WAY_SHARE, CameraMount, aligned, with_untold
from tracker.geometry import wxyz_from_matrix
from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: Chi-square of three numbers that one time in a thousand is exceeded by chance.
_SURPRISE = 16.27
#: Focal lengths that lie this many of their errors apart disagree.
_STRAINED = 2.0


@dataclass(frozen=True, eq=False)
class CommonMount:
    """What recordings tell together; of one recording what it tells alone."""

    mounts: Sequence[CameraMount]
    """Each recording's, as all tell together: they share rotation and focal length."""
    alone: Sequence[CameraMount]
    """Each recording's, as it tells alone."""

    @property
    def R_body_cam(self) -> Matrix:
        """(3, 3)."""
        return self.mounts[0].alignment.R_body_cam

    @property
    def rotation_sigmas_rad(self) -> Matrix:
        """(3,) standard errors of the rotation, rising."""
        return self.mounts[0].alignment.rotation_sigmas_rad

    @property
    def camera(self) -> CameraModel:
        """With the focal length as found, where it was not known."""
        return self.mounts[0].camera

    @property
    def focal_scatter_px(self) -> float:
        """By how much the turns disagree about the focal length, as its standard error; recordings that disagree make it larger."""
        return self.mounts[0].focal_scatter_px

    @property
    def focal_sigma_px(self) -> float:
        """Standard error of the focal length with what no turn tells, which more recordings do not make smaller."""
        return with_untold(self.focal_scatter_px, self.camera)

    @property
    def focal_strain(self) -> float:
        """How far apart the recordings alone find the focal length, in their errors (Birge's ratio): about 1 where they agree.

        The camera's own way is one of these errors: it is another in every place.
        """
        focals_px = np.array([mount.camera.fx_px for mount in self.alone])
        scatters_px = np.array([mount.focal_scatter_px for mount in self.alone])
        if len(focals_px) < 2 or not np.all(scatters_px > 0.0):
            return 0.0
        weights = 1.0 / (scatters_px**2 + (OWN_WAY_SHARE * focals_px) ** 2)
        off_px = focals_px - np.average(focals_px, weights=weights)
        return float(np.sqrt(np.sum(weights * off_px**2) / (len(focals_px) - 1)))

    @property
    def disagrees(self) -> bool:
        """Whether the recordings are further apart about the focal length than their errors allow."""
        return self.focal_strain > _STRAINED

    @property
    def across(self) -> float:
        """Share of the turning across the line of sight, of the recording that has most of it."""
        return max(mount.across for mount in self.alone)

    @property
    def offsets_s(self) -> Matrix:
        """Added to each recording's camera's time: its gyroscope's time of the same moment."""
        return np.array([mount.alignment.offset_s for mount in self.mounts])

    @property
    def offset_s(self) -> float:
        """The offset as the mean of the recordings, each by its error and by how far they are apart."""
        return float(np.average(self.offsets_s, weights=self._offset_weights()))

    @property
    def offset_sigma_s(self) -> float:
        """Standard error of the offset at the next start: no less than clocks differed from start to start."""
        return max(float(np.sum(self._offset_weights()) ** -0.5), self._offsets_apart_s)

    @property
    def readout_s(self) -> float:
        """From the first row to the last, as a mean over the recordings that tell."""
        told_s = [mount.readout_s for mount in self.mounts if mount.readout_s]
        return float(np.mean(told_s)) if told_s else 0.0

    @property
    def residual_px(self) -> float:
        """What of the pictures' turning the gyroscope does not explain, median."""
        return float(np.average([mount.residual_px for mount in self.mounts], weights=self._counts()))

    @property
    def turn_rad(self) -> float:
        """All turning added up."""
        return sum(mount.turn_rad for mount in self.mounts)

    @property
    def turns(self) -> int:
        """How many turns it rests on."""
        return int(sum(self._counts()))

    @property
    def rotation_apart_rad(self) -> float:
        """How far apart two recordings alone find the mounting, where that is more than their errors allow; else 0."""
        return max(
            (_surprising_rad(first, second) for k, first in enumerate(self.alone) for second in self.alone[k + 1 :]),
            default=0.0,
        )

    def _counts(self) -> list[int]:
        return [len(mount.turns.times_s) for mount in self.mounts]

    @property
    def _offsets_apart_s(self) -> float:
        return float(np.std(self.offsets_s, ddof=1)) if len(self.mounts) > 1 else 0.0

    def _offset_weights(self) -> Matrix:
        sigmas_s = np.array([mount.alignment.offset_sigma_s for mount in self.mounts])
        return np.asarray(1.0 / (sigmas_s**2 + self._offsets_apart_s**2))


def common_mount(alone: Sequence[CameraMount]) -> CommonMount:
    """Return what recordings tell together, from what each tells alone.

    Rotation and focal length are found from all turns at once, each with the weight that the errors of its recording give it.
    Recordings that disagree about the focal length more than their errors allow leave its standard error as large as they are
    apart; and what no turn tells apart from it stays (`with_untold`).

    Args:
        alone: At least one; either all with the focal length found, or all with the same lens known.
    """
    if len(alone) == 1:
        return CommonMount(alone, alone)
    focal_is_free = all(mount.focal_scatter_px > 0.0 for mount in alone)
    R, offsets_s = _rough_rotation(alone), [mount.alignment.offset_s for mount in alone]
    if focal_is_free:
        likely = min(alone, key=lambda mount: mount.focal_scatter_px).camera
        seen = [(mount.track, mount.pairs, mount.t_zero_ns) for mount in alone]
        found, turns, camera = aligned(seen, likely, R, offsets_s, focal_is_free=True)
    else:
        turns, camera = [mount.turns for mount in alone], alone[0].camera
        found = align_all([(mount.track, mount.turns) for mount in alone], R, offsets_s)
    common = CommonMount(
        [
            replace(mount, alignment=alignment, camera=camera, turns=of)
            for mount, alignment, of in zip(alone, found, turns, strict=True)
        ],
        alone,
    )
    if not focal_is_free:
        return common
    scatter_px = found[0].log_focal_sigma * camera.fx_px
    if common.disagrees:
        apart_px = float(np.std([mount.camera.fx_px for mount in alone], ddof=1))
        scatter_px = float(np.hypot(scatter_px, apart_px / np.sqrt(len(alone))))
    return replace(common, mounts=[replace(mount, focal_scatter_px=scatter_px) for mount in common.mounts])


def _rough_rotation(alone: Sequence[CameraMount]) -> Matrix:
    """Return the rotation that best lays all recordings' turns on their gyroscopes'."""
    felt, seen = [], []
    for mount in alone:
        times_s = mount.turns.times_s + mount.alignment.offset_s
        known = mount.track.knows(*times_s.T)
        steady = mount.track.without(mount.alignment.bias_rad_s)
        felt.append(rotations.log(steady.between(*times_s[known].T)))
        seen.append(mount.turns.vectors_rad[known])
    p = np.concatenate(seen)
    return rotations.nearest_rotation(np.concatenate(felt), p, np.ones(len(p)))


def _surprising_rad(first: CameraMount, second: CameraMount) -> float:
    """Return the angle between two recordings' mounts; 0 where their errors make it no surprise."""
    one, other = first.alignment, second.alignment
    apart = rotations.log(np.array([wxyz_from_matrix(one.R_body_cam.T @ other.R_body_cam)]))[0]
    surprise = float(apart @ np.linalg.solve(one.rotation_rad2 + other.rotation_rad2, apart))
    return float(np.linalg.norm(apart)) if surprise > _SURPRISE else 0.0
