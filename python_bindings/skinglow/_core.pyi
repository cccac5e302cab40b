from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

def __getattr__(name: str) -> Any: ...  # noqa: ANN401  what is not typed below

# Tables (bind_core.cpp)

class BaseLut:
    def __init__(self, values: ArrayLike, max_thickness_mm: float) -> None: ...
    @property
    def matrices(self) -> Array: ...
    @property
    def thickness_mm(self) -> Array: ...
    @property
    def size(self) -> int: ...
    @property
    def max_thickness_mm(self) -> float: ...
    @property
    def texel_mapping(self) -> tuple[float, float]: ...
    def __len__(self) -> int: ...

# Skin (bind_tissue.cpp)

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
    def replace(self, **changes: float) -> Tissue: ...
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

TISSUE_PARAMETERS: Final[dict[str, tuple[float, float, float, str, str]]]
TISSUE_PRESETS: Final[dict[str, Tissue]]

class SkinLutReport:
    @property
    def streams(self) -> int: ...
    @property
    def thickness_nodes_mm(self) -> Array: ...
    @property
    def wavelengths_nm(self) -> Array: ...
    @property
    def pairs_solved(self) -> int: ...
    @property
    def pairs_skipped(self) -> int: ...
    @property
    def stream_error(self) -> float: ...
    @property
    def node_error(self) -> float: ...
    @property
    def wavelength_error(self) -> float: ...
    @property
    def estimated_error(self) -> float: ...

def transmittance(
    tissue: Tissue,
    thickness_mm: ArrayLike,
    wavelength_nm: ArrayLike,
    incidence: Literal["normal", "diffuse"] | float = "diffuse",
    streams: int = 16,
) -> Array: ...
def diffusion_transmittance(tissue: Tissue, thickness_mm: ArrayLike, wavelength_nm: ArrayLike) -> Array: ...
def skin_layers(tissue: Tissue, total_thickness_mm: float, wavelength_nm: float) -> list[Any]: ...
def base_lut(tissue: Tissue, size: int = 256, max_thickness_mm: float = 12.0, tolerance: float = 1e-3) -> BaseLut: ...
def base_lut_report(
    tissue: Tissue, size: int = 256, max_thickness_mm: float = 12.0, tolerance: float = 1e-3
) -> tuple[BaseLut, SkinLutReport]: ...
def base_lut_by_plan(
    tissue: Tissue,
    size: int = 256,
    max_thickness_mm: float = 12.0,
    streams: int = 16,
    nodes: int = 17,
    wavelength_step: int = 4,
) -> tuple[BaseLut, SkinLutReport]: ...
def reference_lut(tissue: Tissue, size: int = 256, max_thickness_mm: float = 12.0, streams: int = 64) -> BaseLut: ...
def lut_error(lut: BaseLut, exact: BaseLut) -> float: ...

# Spectra (bind_spectrum.cpp)

SAMPLE_WAVELENGTHS_NM: Final[Array]
D65_SPECTRUM: Final[Array]

def rgb_spectrum(rgb: ArrayLike) -> Array: ...
def blackbody_spectrum(temperature_k: float) -> Array: ...
def line_spectrum(centre_nm: float, fwhm_nm: float) -> Array: ...
def tabulated_spectrum(wavelength_nm: ArrayLike, power: ArrayLike) -> Array: ...
def spectral_colour(spectrum: ArrayLike, transmittance: ArrayLike | None = None) -> Array: ...
def transmission_matrix(transmittance: ArrayLike) -> Array: ...

# POV-Ray (bind_povray.cpp)

def povray_scene(
    vertices: ArrayLike,
    triangles: ArrayLike,
    lut_u: ArrayLike,
    *,
    camera_matrix: ArrayLike,
    resolution: ArrayLike,
    projection: ArrayLike | None = None,
    angle_x: float | None = None,
    ortho_width: float | None = None,
    shift: ArrayLike = (0.0, 0.0),
    mode: Literal["existing", "paper", "physical"] = "paper",
    base: object | None = None,
    size: int | None = None,
    max_thickness_mm: float | None = None,
    image: str = "",
    lights: list[object] = ...,
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
) -> dict[str, str]: ...
