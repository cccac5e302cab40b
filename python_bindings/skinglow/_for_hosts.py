"""Small computations that a host such as Blender needs around tables, meshes and lights."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._numbers import fixed, real_numbers, whole_number

if TYPE_CHECKING:
    from skinglow._core import Light, SurfaceLighting

#: Rec.709 luminance (ITU-R BT.709-6, item 3.2 of part 1).
LUMINANCE = fixed(np.array((0.2126, 0.7152, 0.0722)))
#: Seed of `stratified_indices`: any, but the same each time.
SEED = 1
#: Relative difference up to which distances have changed by one factor: single precision over the size of a mesh.
SAME_FACTOR = 1e-4


def luminance(colors: ArrayLike) -> NDArray[np.float64]:
    """Luminance of linear Rec.709 colors (..., 3), (...), at least 0 (ITU-R BT.709-6); else ValueError."""
    found: NDArray[np.float64] = np.maximum(_of_shape("colors", colors, "(..., 3)") @ LUMINANCE, 0.0)
    return found


def diffuse_radiance(exitance: ArrayLike) -> NDArray[np.float64]:
    """Radiance, W/(m^2 sr), of light that leaves a surface diffusely (Lambert's cosine law): exitance, W/m^2, / pi."""
    return real_numbers("exitance", exitance) / np.pi


def visible_entries(table: ArrayLike, threshold: float = 1.0 / 255.0) -> int:
    """Number of entries of a table (size, 3), thin skin first, up to the last that a picture shows; at least 1.

    threshold  the brightest channel from which an entry is visible, as a fraction of the table's brightest
    Raises ValueError for a table of another shape.
    """
    brightest = _of_shape("table", table, "(size, 3), not empty").max(axis=1)
    visible = np.flatnonzero(brightest > threshold * max(brightest.max(), 0.0))
    return int(visible[-1]) + 1 if len(visible) else 1


def stratified_indices(count: int, samples: int) -> NDArray[np.int64]:
    """Indices of at most `samples` of `count` elements, ascending, the same each time; all of them if there are fewer.

    One random index per stratum. Neighbors in a mesh's order mostly are neighbors in space, while equal steps could
    follow a grid's columns. Half the error of independent random samples (measured on a scanned head).
    Raises ValueError for a count below 0 or less than one sample.
    """
    for name, number, least in (("count", count, 0), ("samples", samples, 1)):
        if not whole_number(name, number, largest=2**63 - 1) >= least:
            raise ValueError(f"{name} is {number!r}; allowed: {least} or more")
    if count <= samples:
        return np.arange(count)
    within = np.random.default_rng(SEED).random(samples)
    return ((np.arange(samples) + within) * count / samples).astype(np.int64)


def uniform_scale(before: ArrayLike, after: ArrayLike) -> float | None:
    """Factor by which points were scaled, whatever else turned and moved them as a whole.

    before, after  (n, 3), else ValueError
    Returns None if no one factor explains the distances between successive points, or if there are none.
    """
    then, now = (np.linalg.norm(np.diff(points, axis=0), axis=1) for points in _both(before, after))
    apart = then > 0.0
    if not apart.any():
        return None
    factors = now[apart] / then[apart]
    largest = float(factors.max())
    return largest if largest > 0.0 and largest - factors.min() <= SAME_FACTOR * largest else None


def is_mirrored(before: ArrayLike, after: ArrayLike) -> bool:
    """Whether the linear map that takes points to where they are now, by least squares, mirrors them.

    before, after  (n, 3), else ValueError
    False of points in one plane, or fewer than four: a rotation takes them there, too.
    """
    then, now = _both(before, after)
    if len(then) < 4:
        return False
    linear = np.linalg.lstsq(then - then.mean(axis=0), now - now.mean(axis=0), rcond=None)[0]
    return bool(np.linalg.det(linear) < -SAME_FACTOR * np.linalg.norm(linear) ** 3)


def light_rotation(light: "Light") -> NDArray[np.float64]:
    """Rotation (3, 3) of a light that shines along its own -z axis, with its width along x; columns are its axes.

    A point light, which has no direction, is not rotated.
    """
    z_axis = -np.asarray(light.direction, np.float64)
    if light.kind == "POINT" or not z_axis.any():
        return np.eye(3)
    z_axis = _unit(z_axis)
    wanted = light.tangent if light.kind == "AREA" else (1.0, 0.0, 0.0)
    # A tangent along the direction says nothing: take the axis that is farthest from it.
    for x_axis in (np.asarray(wanted, np.float64), np.eye(3)[np.argmin(np.abs(z_axis))]):
        x_axis = _unit(x_axis)
        x_axis = x_axis - (x_axis @ z_axis) * z_axis
        if np.linalg.norm(x_axis) > 1e-6:
            break
    x_axis /= np.linalg.norm(x_axis)
    return np.column_stack((x_axis, np.cross(z_axis, x_axis), z_axis))


def irradiance_difference(
    lighting: "SurfaceLighting", reference: "SurfaceLighting", box_min: ArrayLike, box_max: ArrayLike
) -> float:
    """How far one lighting of a surface is from another about a box: the largest difference of irradiance in any
    channel, over the largest irradiance of the reference. 0 where both are dark, inf where the reference alone is.

    box_min, box_max  (3,), scene unit, else ValueError
    Looked at are the box's corners, the middles of its edges and sides and its own, each facing along all six axes.
    """
    ends = [_corner(name, end) for name, end in (("box_min", box_min), ("box_max", box_max))]
    steps = np.indices((3, 3, 3)).reshape(3, -1).T / 2.0
    points = (1.0 - steps) * ends[0] + steps * ends[1]
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    where = np.repeat(points, len(normals), axis=0), np.tile(normals, (len(points), 1))
    found, right = lighting.irradiance(*where), reference.irradiance(*where)
    difference, largest = float(np.abs(found - right).max()), float(np.abs(right).max())
    if difference == 0.0:
        return 0.0
    return difference / largest if largest > 0.0 else np.inf


def _corner(name: str, given: ArrayLike) -> NDArray[np.float64]:
    corner = real_numbers(name, given)
    if corner.shape != (3,):
        raise ValueError(f"{name} is of shape {corner.shape}; allowed: shape (3,)")
    return corner


def _both(before: ArrayLike, after: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """As many points, (n, 3) each, else ValueError."""
    both = _of_shape("before", before, "(n, 3)"), _of_shape("after", after, "(n, 3)")
    if len(both[0]) != len(both[1]):
        raise ValueError(f"after is of shape {both[1].shape}; allowed: that of before, {both[0].shape}")
    return both


def _of_shape(name: str, given: ArrayLike, shape: str) -> NDArray[np.float64]:
    """Numbers of a shape that ends with 3, of two dimensions unless it begins with "..."."""
    numbers = real_numbers(name, given)
    fits = numbers.ndim > 0 and numbers.shape[-1] == 3 and (shape.startswith("(...") or numbers.ndim == 2)
    if not fits or ("not empty" in shape and not numbers.size):
        raise ValueError(f"{name} is of shape {numbers.shape}; allowed: shape {shape}")
    return numbers


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """The vector at length 1, also where its square would over- or underflow; 0 stays."""
    largest = np.abs(vector).max()
    if largest == 0.0:
        return vector
    scaled: NDArray[np.float64] = vector / largest
    return scaled / float(np.linalg.norm(scaled))
