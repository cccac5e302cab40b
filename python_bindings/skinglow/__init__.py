"""Skin that glows in the color of your lights: recolored lookup tables for thin, back-lit skin.

Data flows one way: lights -> light_weight -> recolor(base, B + L) -> a host's image.
mm, W, nm, radians and linear Rec.709 everywhere; arrays are numpy float64; bad input raises ValueError.
Importing this loads neither OpenImageIO nor Embree: Blender has libraries of its own.
"""

from skinglow._core import (
    D65_SPECTRUM,
    LEGACY_AREA_POWER_FACTOR,
    PAPER_BLOOD_WEIGHT,
    SAMPLE_WAVELENGTHS_NM,
    TISSUE_PARAMETERS,
    TISSUE_PRESETS,
    AngularWeight,
    BaseLut,
    Environment,
    FaceTiles,
    Layer,
    Light,
    LightRig,
    PreparedRig,
    SkinLutReport,
    SlabResult,
    SurfaceLighting,
    ThicknessCurve,
    TileTargets,
    Tissue,
    __version__,
    attenuation,
    base_lut,
    base_lut_report,
    black_body_color,
    blackbody_spectrum,
    directional_transmittance,
    exposure_factor,
    far_side,
    far_side_irradiance,
    legacy_sun_power_factor,
    light_report,
    light_weight,
    light_weights,
    lut_error,
    merge_identical,
    normal_cone,
    object_irradiance,
    object_irradiance_by_light,
    object_irradiance_error,
    povray_files,
    povray_frame_choice,
    povray_macros,
    read_light_rig,
    recolor,
    reference_lut,
    rgb_spectrum,
    six_gaussian_base,
    six_gaussian_lookup,
    skin_angular_weight,
    skin_layers,
    slab,
    spectral_color,
    surface_irradiance,
    table_at,
    tabulated_spectrum,
    transmission_matrix,
    transmittance,
    unnormalized_power_factor,
)
from skinglow._for_hosts import (
    diffuse_radiance,
    irradiance_difference,
    is_mirrored,
    light_rotation,
    luminance,
    stratified_indices,
    uniform_scale,
    visible_entries,
)
from skinglow._lit_shape import LitShape
from skinglow._occlusion import Occluders, VisibleFraction
from skinglow._pickled import register as _register
from skinglow._renamed import __getattr__ as __getattr__
from skinglow._shape import Shape, ShapePart
from skinglow._spectra import line_spectrum
from skinglow._thickness import ThicknessReport, thickness, thickness_report
from skinglow._thickness_map import (
    ThicknessImage,
    ThicknessSummary,
    bake_thickness,
    gray_png,
    sample_image,
    thickness_colors,
    thickness_summary,
)
from skinglow._thin_skin import near_thin_skin

_register()

__all__ = [
    "__version__",
    # Lights, and the paper's weight of them (Eq. 2 and 3)
    "Light",
    "attenuation",
    "light_weight",
    "light_weights",
    # Tables (Eq. 1)
    "BaseLut",
    "PAPER_BLOOD_WEIGHT",
    "recolor",
    "table_at",
    "six_gaussian_base",
    "six_gaussian_lookup",
    # Slabs of turbid media
    "Layer",
    "SlabResult",
    "ThicknessCurve",
    "directional_transmittance",
    "slab",
    # Tissue, and tables of it
    "TISSUE_PARAMETERS",
    "TISSUE_PRESETS",
    "SkinLutReport",
    "Tissue",
    "base_lut",
    "base_lut_report",
    "lut_error",
    "reference_lut",
    "skin_layers",
    "transmittance",
    # Spectra
    "D65_SPECTRUM",
    "SAMPLE_WAVELENGTHS_NM",
    "blackbody_spectrum",
    "line_spectrum",
    "rgb_spectrum",
    "spectral_color",
    "tabulated_spectrum",
    "transmission_matrix",
    # Irradiance, and the power of lights
    "LEGACY_AREA_POWER_FACTOR",
    "AngularWeight",
    "Environment",
    "black_body_color",
    "exposure_factor",
    "far_side",
    "far_side_irradiance",
    "object_irradiance",
    "object_irradiance_by_light",
    "legacy_sun_power_factor",
    "skin_angular_weight",
    "surface_irradiance",
    "unnormalized_power_factor",
    # Which lights matter, and what each does
    "PreparedRig",
    "light_report",
    "merge_identical",
    "normal_cone",
    "object_irradiance_error",
    # Light rigs from files
    "LightRig",
    "read_light_rig",
    # The light at each point of a surface, for materials
    "SurfaceLighting",
    # Values on a surface as texels of an image
    "FaceTiles",
    "TileTargets",
    # For hosts
    "diffuse_radiance",
    "irradiance_difference",
    "is_mirrored",
    "light_rotation",
    "luminance",
    "stratified_indices",
    "uniform_scale",
    "visible_entries",
    # POV-Ray
    "povray_files",
    "povray_frame_choice",
    "povray_macros",
    # Meshes
    "Occluders",
    "VisibleFraction",
    # Light through the real shape
    "LitShape",
    "Shape",
    "ShapePart",
    "near_thin_skin",
    "ThicknessImage",
    "ThicknessReport",
    "ThicknessSummary",
    "bake_thickness",
    "gray_png",
    "sample_image",
    "thickness",
    "thickness_colors",
    "thickness_report",
    "thickness_summary",
]
