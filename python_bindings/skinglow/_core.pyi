"""Types of the compiled module. help(skinglow.<name>) has units, ranges and sources."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, ClassVar, Final, Literal, TypeAlias, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._results import CullingResult, DirectionalTransmittance, LightKind, LightReportEntry

_Array = NDArray[np.float64]
_Rgb = tuple[float, float, float]
_Incidence = Literal["normal", "diffuse"] | float  # a number: the cosine to the normal

__version__: Final[str]

# Lights (bind_light.cpp)

class Light:
    def __init__(
        self,
        kind: LightKind = "POINT",
        color: ArrayLike = (1.0, 1.0, 1.0),
        position: ArrayLike = (0.0, 0.0, 0.0),
        direction: ArrayLike = (0.0, 0.0, -1.0),
        power: float = 1.0,
        name: str = "",
        visible: bool = True,
        *,
        radius: float = 0.0,
        soft_falloff: bool = True,
        sun_angle: float = 0.0,
        spot_angle: float = 0.7853981633974483,
        spot_blend: float = 0.15,
        spot_cosine: bool = False,
        area_shape: Literal["RECTANGLE", "SQUARE", "ELLIPSE", "DISK"] = "RECTANGLE",
        size_x: float = 0.001,
        size_y: float = 0.001,
        tangent: ArrayLike = (1.0, 0.0, 0.0),
        spread: float = 3.141592653589793,
    ) -> None: ...
    @property
    def kind(self) -> LightKind: ...
    @property
    def color(self) -> _Array: ...
    @property
    def position(self) -> _Array: ...
    @property
    def direction(self) -> _Array: ...
    @property
    def power(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def visible(self) -> bool: ...
    @property
    def radius(self) -> float: ...
    @property
    def soft_falloff(self) -> bool: ...
    @property
    def sun_angle(self) -> float: ...
    @property
    def spot_angle(self) -> float: ...
    @property
    def spot_blend(self) -> float: ...
    @property
    def spot_cosine(self) -> bool: ...
    @property
    def area_shape(self) -> Literal["RECTANGLE", "ELLIPSE"]: ...
    @property
    def size_x(self) -> float: ...
    @property
    def size_y(self) -> float: ...
    @property
    def tangent(self) -> _Array: ...
    @property
    def spread(self) -> float: ...
    @property
    def is_on(self) -> bool: ...
    def moved(self, motion: ArrayLike) -> Light: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...

# Weights and tables (bind_core.cpp)

PAPER_BLOOD_WEIGHT: Final[_Rgb]

_Lights: TypeAlias = "PreparedRig | Sequence[Light]"

@overload
def attenuation(distance: float, coefficients: ArrayLike = (1.0, 0.0, 1.0)) -> float: ...
@overload
def attenuation(
    distance: NDArray[Any] | Sequence[Any], coefficients: ArrayLike = (1.0, 0.0, 1.0)
) -> _Array: ...  # a float for an array without dimensions
def light_weights(lights: _Lights, point: ArrayLike, coefficients: ArrayLike = (1.0, 0.0, 1.0)) -> _Array: ...
def light_weight(lights: _Lights, point: ArrayLike, coefficients: ArrayLike = (1.0, 0.0, 1.0)) -> _Array: ...

class BaseLut:
    def __init__(self, values: ArrayLike, max_thickness_mm: float) -> None: ...
    @property
    def matrices(self) -> _Array: ...
    @property
    def thickness_mm(self) -> _Array: ...
    @property
    def size(self) -> int: ...
    @property
    def max_thickness_mm(self) -> float: ...
    @property
    def texel_mapping(self) -> tuple[float, float]: ...
    def __len__(self) -> int: ...

def recolor(base: BaseLut, weight: ArrayLike) -> _Array: ...
def table_at(colors: ArrayLike, texel_mapping: tuple[float, float], thickness_mm: ArrayLike) -> _Array: ...
def six_gaussian_lookup(size: int = 256, max_thickness_mm: float = 12.0) -> _Array: ...
def six_gaussian_base(size: int = 256, max_thickness_mm: float = 12.0) -> BaseLut: ...

# Slab (bind_slab.cpp)

class Layer:
    refractive_index: float
    absorption: float
    scattering: float
    anisotropy: float
    thickness: float
    def __init__(
        self,
        refractive_index: float = 1.4,
        absorption: float = 0.0,
        scattering: float = 0.0,
        anisotropy: float = 0.0,
        thickness: float = 0.0,
    ) -> None: ...
    def __eq__(self, other: object) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

class SlabResult:
    """Made by slab alone."""

    @property
    def reflectance(self) -> float: ...
    @property
    def transmittance(self) -> float: ...
    @property
    def unscattered(self) -> float: ...
    @property
    def absorbed(self) -> _Array: ...

def slab(
    layers: Sequence[Layer],
    incidence: _Incidence = "normal",
    n_above: float = 1.0,
    n_below: float = 1.0,
    streams: int = 16,
) -> SlabResult: ...
def directional_transmittance(
    layers: Sequence[Layer], n_above: float = 1.0, n_below: float = 1.0, streams: int = 16
) -> DirectionalTransmittance: ...

class ThicknessCurve:
    def __init__(
        self,
        layers: Sequence[Layer],
        variable_layer: int = 0,
        incidence: _Incidence = "diffuse",
        n_above: float = 1.0,
        n_below: float = 1.0,
        streams: int = 16,
    ) -> None: ...
    def transmittance(self, thickness_mm: ArrayLike) -> _Array: ...
    @property
    def decay_rate(self) -> float: ...

# Skin (bind_tissue.cpp)

TISSUE_PARAMETERS: Final[dict[str, tuple[float, float, float, str, str]]]
"""Default, minimum, maximum, unit and description by name."""

TISSUE_PRESETS: Final[dict[str, Tissue]]

class Tissue:
    def __init__(
        self,
        *,
        melanin_fraction: float = 0.038,
        blood_fraction: float = 0.01,
        oxygen_saturation: float = 0.75,
        epidermal_thickness_mm: float = 0.06,
        scattering_scale: float = 1.0,
        refractive_index: float = 1.4,
        cartilage_fraction: float = 0.0,
    ) -> None: ...
    def replace(
        self,
        *,
        melanin_fraction: float = ...,
        blood_fraction: float = ...,
        oxygen_saturation: float = ...,
        epidermal_thickness_mm: float = ...,
        scattering_scale: float = ...,
        refractive_index: float = ...,
        cartilage_fraction: float = ...,
    ) -> Tissue: ...
    @property
    def melanin_fraction(self) -> float: ...
    @property
    def blood_fraction(self) -> float: ...
    @property
    def oxygen_saturation(self) -> float: ...
    @property
    def epidermal_thickness_mm(self) -> float: ...
    @property
    def scattering_scale(self) -> float: ...
    @property
    def refractive_index(self) -> float: ...
    @property
    def cartilage_fraction(self) -> float: ...
    @property
    def description(self) -> str: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...

class SkinLutReport:
    """Made by base_lut_report alone."""

    @property
    def streams(self) -> int: ...
    @property
    def estimated_error(self) -> float: ...

def transmittance(
    tissue: Tissue,
    thickness_mm: ArrayLike,
    wavelength_nm: ArrayLike,
    incidence: _Incidence = "diffuse",
    streams: int = 16,
    threads: int = 0,
) -> _Array: ...
def skin_layers(tissue: Tissue, total_thickness_mm: float, wavelength_nm: float) -> list[Layer]: ...
def base_lut(
    tissue: Tissue, size: int = 256, max_thickness_mm: float = 12.0, tolerance: float = 1e-3, threads: int = 0
) -> BaseLut: ...
def base_lut_report(
    tissue: Tissue, size: int = 256, max_thickness_mm: float = 12.0, tolerance: float = 1e-3, threads: int = 0
) -> tuple[BaseLut, SkinLutReport]: ...
def reference_lut(
    tissue: Tissue, size: int = 256, max_thickness_mm: float = 12.0, streams: int = 64, threads: int = 0
) -> BaseLut: ...
def lut_error(lut: BaseLut, exact: BaseLut) -> float: ...

# Spectra (bind_spectrum.cpp)

SAMPLE_WAVELENGTHS_NM: Final[_Array]
D65_SPECTRUM: Final[_Array]

def rgb_spectrum(rgb: ArrayLike) -> _Array: ...
def blackbody_spectrum(temperature_k: float) -> _Array: ...
def line_spectrum(center_nm: float, fwhm_nm: float) -> _Array: ...
def tabulated_spectrum(wavelength_nm: ArrayLike, power: ArrayLike) -> _Array: ...
def spectral_color(spectrum: ArrayLike, transmittance: ArrayLike | None = None) -> _Array: ...
def transmission_matrix(transmittance: ArrayLike) -> _Array: ...

# Irradiance (bind_irradiance.cpp)

LEGACY_AREA_POWER_FACTOR: Final[float]
"""pi / 4: the factor on the power of an area light in Blender 3.4."""

class AngularWeight:
    def __init__(self, mu: ArrayLike, transmittance: ArrayLike) -> None: ...
    def at(self, mu: ArrayLike) -> _Array: ...

class Environment:
    def __init__(self, radiance: ArrayLike) -> None: ...
    @staticmethod
    def from_image(
        pixels: ArrayLike,
        *,
        projection: Literal["EQUIRECTANGULAR", "MIRROR_BALL"] = "EQUIRECTANGULAR",
        bottom_first: bool = False,
    ) -> Environment: ...
    def rotated(self, rotation: ArrayLike) -> Environment: ...
    def irradiance(self, normals: ArrayLike, angular_weight: AngularWeight | None = None) -> _Array: ...
    @property
    def mean_irradiance(self) -> _Array: ...
    @property
    def mean_irradiance_error(self) -> _Array: ...
    @property
    def coefficients(self) -> _Array: ...

def object_irradiance_by_light(lights: _Lights, point: ArrayLike, tolerance: float = 1e-7) -> _Array: ...
def object_irradiance(lights: _Lights, point: ArrayLike, tolerance: float = 1e-7) -> _Array: ...
def surface_irradiance(
    lights: _Lights,
    points: ArrayLike,
    normals: ArrayLike,
    *,
    angular_weight: AngularWeight | None = None,
    environment: Environment | None = None,
    tolerance: float = 1e-7,
    threads: int = 0,
) -> _Array: ...
def far_side(vertices: ArrayLike, normals: ArrayLike, depth: ArrayLike) -> tuple[_Array, _Array]: ...
def far_side_irradiance(
    lights: _Lights,
    vertices: ArrayLike,
    normals: ArrayLike,
    depth: ArrayLike,
    *,
    angular_weight: AngularWeight | None = None,
    environment: Environment | None = None,
    tolerance: float = 1e-7,
    threads: int = 0,
) -> _Array: ...

class SurfaceLighting:
    def __init__(
        self,
        lights: _Lights,
        box_min: ArrayLike,
        box_max: ArrayLike,
        environment: Environment | None = None,
        angular_weight: AngularWeight | None = None,
        max_terms: int = 8,
        tolerance: float = 0.01,
    ) -> None: ...
    @property
    def terms(self) -> _Array: ...
    @property
    def plain_terms(self) -> int: ...
    @property
    def lights_of_terms(self) -> list[int]: ...
    @property
    def far_lights(self) -> list[int]: ...
    @property
    def polynomial(self) -> _Array: ...
    @property
    def angular(self) -> _Array: ...
    def irradiance(self, points: ArrayLike, normals: ArrayLike) -> _Array: ...

def skin_angular_weight(tissue: Tissue, thickness_mm: float = 4.0, streams: int = 16) -> AngularWeight: ...
def normal_cone(normals: ArrayLike) -> tuple[_Array, float]: ...
def exposure_factor(stops: float) -> float: ...
def unnormalized_power_factor(light: Light) -> float: ...
def black_body_color(kelvin: float) -> _Array: ...
def legacy_sun_power_factor(angle: float) -> float: ...

# Choice of lights and what each does (bind_light_choice.cpp)

class PreparedRig:
    def __init__(self, lights: _Lights) -> None: ...
    @property
    def lights(self) -> list[Light]: ...
    def cull(self, box_min: ArrayLike, box_max: ArrayLike, tolerance: float) -> CullingResult: ...
    def __len__(self) -> int: ...

def merge_identical(lights: _Lights) -> list[Light]: ...
def object_irradiance_error(
    lights: _Lights,
    point: ArrayLike,
    box_min: ArrayLike,
    box_max: ArrayLike,
    facing: tuple[ArrayLike, float] | None = None,
) -> _Array: ...
def light_report(
    lights: _Lights,
    point: ArrayLike,
    normal: ArrayLike | None = None,
    occluded: Sequence[bool] = [],
    kept: Sequence[int] | None = None,
) -> list[LightReportEntry]: ...

# Light rigs from files (bind_rig.cpp)

class LightRig:
    @property
    def name(self) -> str: ...
    @property
    def point(self) -> _Array: ...
    @property
    def coefficients(self) -> _Array: ...
    @property
    def blood_weight(self) -> _Array: ...
    @property
    def lights(self) -> list[Light]: ...
    @property
    def notes(self) -> list[str]: ...

def read_light_rig(
    path: str | bytes | PathLike[str] | PathLike[bytes], camera_rotation: ArrayLike | None = None
) -> LightRig: ...

# POV-Ray (bind_povray.cpp)

def povray_macros() -> str: ...
def povray_frame_choice(files: Sequence[tuple[int, str]]) -> str: ...
def povray_files(
    vertices: ArrayLike,
    triangles: ArrayLike,
    lut_u: ArrayLike | None = None,
    *,
    camera_matrix: ArrayLike,
    resolution: ArrayLike,
    projection: ArrayLike | None = None,
    angle_x: float | None = None,
    ortho_width: float | None = None,
    shift: ArrayLike = (0.0, 0.0),
    mode: Literal["existing", "paper", "physical"] = "paper",
    base: BaseLut | None = None,
    size: int | None = None,
    max_thickness_mm: float | None = None,
    image: str = "",
    lights: Sequence[Light] = [],
    point: ArrayLike = (0.0, 0.0, 0.0),
    coefficients: ArrayLike = (1.0, 0.0, 1.0),
    blood_weight: ArrayLike = (1.8, 0.5, 0.4),
    strength: float = 1.0,
    normals: ArrayLike | None = None,
    surface_color: ArrayLike | None = None,
    surface_image: str = "",
    surface_uv: ArrayLike | None = None,
    background: ArrayLike = (0.0, 0.0, 0.0),
    name: str = "skin",
    glow_uv: ArrayLike | None = None,
    world_irradiance: ArrayLike = (0.0, 0.0, 0.0),
    thickness_image: str = "",
    thickness_range: ArrayLike = (0.0, 1.0),
    frames: tuple[int, int, float] | None = None,
    instances: Sequence[ArrayLike] = [],
) -> dict[str, str]: ...

# Values on a surface as texels of an image (bind_face_tiles.cpp)

class FaceTiles:
    WIDTH: ClassVar[int]
    def __init__(
        self,
        vertices: ArrayLike,
        face_sizes: ArrayLike,
        corners: ArrayLike,
        wanted: ArrayLike | None = None,
        *,
        unit_mm: float = 1.0,
        spacing_mm: float = 0.8,
        max_texels: int = 1048576,
    ) -> None: ...
    @property
    def texels(self) -> NDArray[np.float32]: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def tiles(self) -> int: ...
    @property
    def spacing_mm(self) -> float: ...

class TileTargets:
    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        texels: ArrayLike,
        height: int,
        *,
        unit_mm: float = 1.0,
    ) -> None: ...
    @property
    def points(self) -> _Array: ...
    @property
    def normals(self) -> _Array: ...
    @property
    def of_texel(self) -> NDArray[np.int32]: ...
    @property
    def overlapping(self) -> float: ...
    @property
    def mixed(self) -> float: ...
    @property
    def spacing_mm(self) -> float: ...
    def at_vertices(self, values: ArrayLike) -> _Array: ...
    def spread(self, values: ArrayLike, out: NDArray[np.float32] | None = None) -> NDArray[np.float32]: ...
