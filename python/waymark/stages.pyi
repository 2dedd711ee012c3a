# SPDX-License-Identifier: Apache-2.0
# Written by scripts/update-python from the declarations of the C++ library.
from typing import Any

def describe(name: str) -> dict[str, Any]: ...

def align_images(*, enabled: bool = ..., max_images: int = ..., wrong_geometry: str = ...) -> dict[str, Any]:
    """Corrects the poses of images by the landmarks they share.

    enabled: Correct poses; false leaves them as given
    max_images: Most images that are aligned; the time grows with the third power (at least 2, at most 2000)
    wrong_geometry: What happens if objects of one image are hardly found again in others (one of refuse, warn)"""
    ...

def buildings_from_canopy(*, min_height: float = ..., min_area: float = ..., max_extent: float = ..., roughness: float = ..., min_confidence: float = ..., min_wall: float = ..., overhang: float = ..., overhang_sd: float = ..., survey_sd: float = ...) -> dict[str, Any]:
    """Finds roofs in laser points or a surface model: buildings, their walls and corners.

    min_height [m]: Lowest roof above the ground (at least 1, at most 50)
    min_area: Smallest footprint kept, m2 (at least 4, at most 100000)
    max_extent [m]: Widest connected group of roofs; wider ones are rejected. Tiles read this far around (at least 20, at most 2000)
    roughness [m]: Root mean square distance of returns from the plane of their roof; more is vegetation (at least 0.02, at most 1)
    min_confidence: Roofs less probable than this are rejected (at least 0, at most 1)
    min_wall [m]: Shortest wall kept as a landmark (at least 0.5, at most 100)
    overhang [m]: Distance of the eaves from the walls: walls and corners are moved in by it (at least 0, at most 3)
    overhang_sd [m]: Standard deviation of the overhang, part of that of walls and corners (at least 0, at most 3)
    survey_sd [m]: Horizontal standard deviation of the survey as a whole (at least 0, at most 10)"""
    ...

def check_sun(*, tolerance: float = ..., max_pixels: int = ...) -> dict[str, Any]:
    """Compares the given sun with the shadows in each image and warns where they disagree.

    tolerance [deg]: Largest difference between given sun and shadows without a warning (at least 1, at most 180)
    max_pixels: Side of the central square of the image that is examined (at least 64, at most 65536)"""
    ...

def craters_from_bowls(*, min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ...) -> dict[str, Any]:
    """Finds craters in an image by shaded bowls, refined rims and a trained model.

    min_diameter: Smallest crater kept, in pixels of the image (at least 6, at most 100000)
    max_diameter: Largest crater kept, in pixels; 0: 0.6 of the image's shorter side (at least 0, at most 1e+06)
    min_confidence: Craters less probable than this are left out (at least 0, at most 1)"""
    ...

def craters_from_dem(*, min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ...) -> dict[str, Any]:
    """Finds craters in a DEM: dishes with rims, their depth and rim height.

    min_diameter: Smallest crater kept, in cells of the DEM (at least 6, at most 400)
    max_diameter: Largest crater kept, in cells; larger ones need a coarser DEM (at least 6, at most 400)
    min_confidence: Craters less probable than this are left out (at least 0, at most 1)"""
    ...

def craters_from_edges(*, min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ...) -> dict[str, Any]:
    """Finds craters in an image by pairing lit and shaded rim edges along the light.

    min_diameter: Smallest crater kept, in pixels of the image (at least 6, at most 100000)
    max_diameter: Largest crater kept, in pixels; 0: 0.6 of the image's shorter side (at least 0, at most 1e+06)
    min_confidence: Craters less probable than this are left out (at least 0, at most 1)"""
    ...

def find_mountain_tops(*, min_prominence: float = ...) -> dict[str, Any]:
    """Finds the summits and saddles of a tile.

    min_prominence [m]: Smallest prominence of a summit that is kept; 0 keeps all (at least 0, at most 40000)"""
    ...

def flat_ground(*, crs: str = ..., height: float = ..., height_sd: float = ...) -> dict[str, Any]:
    """Level ground for images where there is no DEM: the map has no heights then.

    crs: Projected coordinate reference system of the map: EPSG:32633, a PROJ string, or local
    height [m]: Height of the level ground (at least -20000, at most 100000)
    height_sd [m]: Deviation of the real terrain from it: positions seen at an angle become less certain (at least 0, at most 10000)"""
    ...

def join_mountain_tops(*, base: str = ...) -> dict[str, Any]:
    """Joins the tiles: exact prominence, key saddle and parent of each summit.

    base: Reference of the highest summit of each land mass: elevation 0 (sea), the lowest cell, or none; auto: sea if the highest cell lies above 0 (one of auto, sea, lowest, none)"""
    ...

def load_canopy(*, chm: list[str] = ..., dsm: list[str] = ..., dtm: list[str] = ..., las: list[str] = ..., resolution: float = ..., ground_square: float = ..., flights: bool = ..., forest_type: str = ..., crs: str = ..., aoi: str = ..., tile_cells: int = ..., memory: int = ...) -> dict[str, Any]:
    """Opens canopy height models, or surface and terrain models, and cuts them into tiles.

    chm: Canopy height models: heights above ground
    dsm: Surface models, instead of chm; dtm gives the terrain
    dtm: Terrain models under the surface models or the laser points, on any grid
    las: LAS, LAZ or COPC files, instead of chm: one catalogue of laser points, with classified ground (class 2) or with dtm
    resolution [m]: Cell size of the canopy made from laser points; 0: by their density (at least 0, at most 20)
    ground_square [m]: Side of the squares whose lowest points begin the ground where none is classified: wider than the widest roof or crown (at least 5, at most 500)
    flights: Each file of chm (of dsm, of las) is a separate survey: trees found in several are merged. Otherwise the files make one canopy; where they overlap the first one has priority
    forest_type: Raster of forest types, which select the preset for finding treetops: 1 conifer, 2 broadleaf, 3 mixed
    crs: Coordinate reference system instead of the files' own; local: metres on no body
    aoi: Polygons of the area of interest: trees outside are left out, but those inside are found in the whole canopy
    tile_cells: Side of the tiles for processing; the trees do not depend on it (at least 64, at most 16384)
    memory: Memory for decoded rasters, points or trees, megabytes (at least 16, at most 1e+07)"""
    ...

def load_dem(*, files: list[str] = ..., nodata: str = ..., crs: str = ..., height_sd: float = ..., band: int = ..., height_unit: str = ..., height_scale: float = ..., fill_distance: int = ..., aoi: str = ..., metric: bool = ..., tile_cells: int = ..., memory: int = ...) -> dict[str, Any]:
    """Opens elevation rasters as one grid and cuts it into tiles.

    files: Rasters of the DEM; where they overlap the first one has priority. Distances from the body's centre become elevations above its equatorial radius
    nodata: Meaning of cells without a height: ocean (nothing hidden, but beside ground above 100 m), unknown (terrain of any height may be hidden), fill (interpolated, then unknown) (one of ocean, unknown, fill)
    crs: Coordinate reference system instead of the files' own; local: metres on no body
    height_sd [m]: Standard deviation of a height; 0: not known (at least 0, at most 1000)
    band: Band that holds the heights; 0: the only one (at least 0, at most 65536)
    height_unit: Unit of the heights instead of the band's: m, km, dm, cm, mm, ft, us-ft
    height_scale: Factor of all heights, e.g. 0.1 for decimetres (at least 1e-06, at most 1e+06)
    fill_distance: nodata fill: voids are filled up to this many cells from data; the rest stays unknown (at least 1, at most 1000)
    aoi: Polygons of the area of interest: landmarks outside are left out, but measured on the whole DEM
    metric: true: project a DEM in degrees to metres about its middle, as images need it; jobs that load images set it themselves
    tile_cells: Side of the tiles for processing; the map does not depend on it (at least 64, at most 16384)
    memory: Memory for decoded rasters, megabytes; 0: 512 for a DEM that fits, else 96 (up to 512 where rows of tiles touch more) (at least 0, at most 1e+07)"""
    ...

def load_images(*, files: list[str] = ..., cameras: str = ..., camera_format: str = ..., interior: str = ..., crs: str = ..., camera_crs: str = ..., height_offset: float = ..., control_points: str = ..., similarity: str = ..., rotation_sd: float = ..., position_sd: float = ..., sun: str = ..., sun_azimuth: float = ..., sun_elevation: float = ..., sun_sd: float = ..., image_sun_angle: str = ..., time_zone: str = ..., gsd: float = ..., saturated: float = ..., band: int = ...) -> dict[str, Any]:
    """Lists images with their camera or georeference and the sun.

    files: Images, patterns (*.png) or folders of images; empty: those named in the camera file, near it
    cameras: Camera file, or a pattern for several of one format; empty: orthophotos
    camera_format: Format of the camera files (one of auto, bundler, colmap, csm_isd, metashape, odm_shots, opensfm, opk, tsai, waymark)
    interior: File with the interior orientation, for formats that store it separately
    crs: CRS of the map; empty: that of the DEM
    camera_crs: CRS of camera positions if their file names none; empty: the map's
    height_offset [m]: Added to every camera height: minus the height of the DEM's zero (geoid, areoid) above the cameras' (ellipsoid, sphere) (at least -100000, at most 100000)
    control_points: CSV file of control points that georeference an arbitrary camera frame
    similarity: Instead of control points: scale,qw,qx,qy,qz,x,y,z with map = scale * rotation * frame + shift
    rotation_sd [deg]: Standard deviation of camera angles if the camera file gives none (at least 0, at most 180)
    position_sd [m]: Standard deviation of camera positions if the camera file gives none (at least 0, at most 1e+06)
    sun: Source of the sun: auto (camera file, label, then time and position), time, none (one of auto, time, none)
    sun_azimuth [deg]: Direction towards the sun for all images, clockwise from map north; needs sun_elevation (at least -360, at most 360)
    sun_elevation [deg]: Elevation of the sun above the horizon; 0: unknown (at least 0, at most 90)
    sun_sd [deg]: Standard deviation of the given sun angles (at least 0, at most 90)
    image_sun_angle: Direction towards the sun in the images, degrees from x (right) towards y (down); empty: unknown
    time_zone: UTC offset for EXIF times without one: Z, +08:00; empty: unknown
    gsd [m]: Ground size of a pixel, for images without georeference; 0: unknown (at least 0, at most 100000)
    saturated: Pixel value from which pixels are saturated; 0: the largest 8 or 16 bit number (at least 0, at most 1e+12)
    band: Band to use, from 1; 0: brightness (at least 0, at most 10000)"""
    ...

def load_names(*, files: list[str] = ..., layer: str = ..., name_column: str = ..., max_distance: float = ...) -> dict[str, Any]:
    """Reads the names of summits from a gazetteer.

    files: Gazetteers: layers of named points
    layer: Layer of files that hold several
    name_column: Column of the names; empty: name, label or toponym
    max_distance [m]: Largest distance between a landmark and the place whose name it gets (at least 0, at most 100000)"""
    ...

def map_mountain_tops(*, min_isolation: float = ..., visible_range: float = ...) -> dict[str, Any]:
    """Converts summits to landmarks: position, features, visibility, parents.

    min_isolation [m]: Smallest isolation of a summit that is kept (at least 0, at most 4e+07)
    visible_range [m]: Radius around a summit over which its expected visibility is averaged (at least 1, at most 1e+06)"""
    ...

def measure_isolation(*, isolation: str = ..., distance: str = ...) -> dict[str, Any]:
    """Measures the distance of each summit to higher terrain.

    isolation: End point of isolation: nearest higher cell, or interpolated point of equal elevation (one of cell, contact)
    distance: Distances on the body's ellipsoid, or straight on a projected map (one of geodesic, planar)"""
    ...

def merge_observations(*, max_distance: float = ..., position_gate: float = ..., size_gate: float = ..., overlap: float = ..., common_fraction: float = ..., weights: str = ...) -> dict[str, Any]:
    """Merges observations of different images into landmarks.

    max_distance [m]: Largest distance between observations of one landmark; 0: only covariances decide (at least 0, at most 1e+07)
    position_gate: Gate of the squared Mahalanobis distance between observations of one landmark (chi-square, 2 degrees of freedom) (at least 0.1, at most 1000)
    size_gate: Gate for the logarithm of the size (chi-square, 1 degree of freedom) (at least 0.1, at most 1000)
    overlap: Bodies of similar size in different images, nearer than this fraction of their radius, are one regardless of covariances (at least 0, at most 2)
    common_fraction: Fraction of a position's variance common to all images (shape, light, DEM) (at least 0, at most 1)
    weights: Weight of an observation in a merged feature: quality (eq. 3) or precision (one of quality, precision)"""
    ...

def mountain_tops_of_tile(*, min_isolation: float = ..., visible_range: float = ...) -> dict[str, Any]:
    """Converts the summits of a tile to landmarks, as map_mountain_tops does.

    min_isolation [m]: Smallest isolation of a summit that is kept (at least 0, at most 4e+07)
    visible_range [m]: Radius around a summit over which its expected visibility is averaged (at least 1, at most 1e+06)"""
    ...

def poles_from_points(*, min_density: float = ..., min_pole_height: float = ..., max_width: float = ..., clearance: float = ..., min_returns: int = ..., pole_survey_sd: float = ...) -> dict[str, Any]:
    """Finds poles in airborne laser points where their density allows it.

    min_density: First returns per m2 below which no poles are searched, with a warning (at least 0, at most 1000)
    min_pole_height [m]: Lowest pole kept (at least 1.5, at most 40)
    max_width [m]: Widest pole, with its lamp (at least 0.2, at most 3)
    clearance [m]: Distance from a pole to all else that is higher than 1 m (at least 0.3, at most 5)
    min_returns: Fewest returns of a pole (at least 3, at most 1000)
    pole_survey_sd [m]: Horizontal standard deviation of the survey as a whole (at least 0, at most 10)"""
    ...

def project_to_ground(*, height_sd: float = ..., slope_sd: float = ..., outline_edge_fraction: float = ..., shadow_shape: float = ..., rim_shape: float = ..., min_crater_confidence: float = ..., register_to_dem: bool = ...) -> dict[str, Any]:
    """Projects detections onto the DEM, with covariances and footprints.

    height_sd [m]: Standard deviation of heights of a DEM without its own; lowers the accuracy of positions in oblique views (at least 0, at most 1000)
    slope_sd: Standard deviation of the slope under a rock relative to the DEM, metres per metre (at least 0, at most 1)
    outline_edge_fraction: Position of a crater's outline between crest (0) and visible edge (1), by which outlines are widened to the crest where the DEM resolves the crater (at least 0, at most 1)
    shadow_shape: Standard deviation of a rock's centre along the sun due to its shape, in diameters (at least 0, at most 1)
    rim_shape: Standard deviation of a crater's centre due to its uneven rim, in diameters (at least 0, at most 1)
    min_crater_confidence: Smallest probability of a crater that is kept, by image and DEM together (at least 0, at most 1)
    register_to_dem: Register the image to the DEM by its shading, which corrects its pose in align_images"""
    ...

def reject_implausible(*, min_depth_ratio: float = ..., max_height_ratio: float = ...) -> dict[str, Any]:
    """Rejects observations whose features are outside the ranges of their type.

    min_depth_ratio: Smallest depth / diameter of a crater whose depth the DEM resolves (at least 0, at most 0.5)
    max_height_ratio: Largest height / diameter of a rock; higher ones are cliffs and ridges (at least 0.5, at most 100)"""
    ...

def reject_rim_shadows(*, inner: float = ..., outer: float = ..., half_angle: float = ..., min_fraction: float = ..., min_confidence: float = ...) -> dict[str, Any]:
    """Rejects rocks on the light-facing rims of craters, where the shadow is the crater's.

    inner: Inner limit of the rim band, in radii of the crater (at least 0, at most 1)
    outer: Outer limit of the rim band, in radii of the crater (at least 1, at most 5)
    half_angle [deg]: Half angle around the sun's direction in which a rim faces the light (at least 0, at most 180)
    min_fraction: Smallest size, as a fraction of the crater's, of a rock that is rejected (at least 0, at most 1)
    min_confidence: Smallest confidence of a crater whose rim rejects rocks (at least 0, at most 1)"""
    ...

def reject_terrain_shadows(*, min_distance_cells: float = ..., min_cells: float = ..., min_drop: float = ..., min_stands_out: float = ...) -> dict[str, Any]:
    """Rejects rocks whose shadow the terrain explains, by tracing rays to the sun.

    min_distance_cells: Smallest distance of shadow-casting terrain, in cells of the DEM (at least 0, at most 1000)
    min_cells: Smallest diameter, in cells of the DEM, of a rock that the DEM's relief can refute (at least 1, at most 1000)
    min_drop: Smallest fraction of the light that the DEM's relief takes from a shadow's area to refute its rock; 1: never (at least 0, at most 1)
    min_stands_out: Smallest fraction of its height by which a rock stands out of a fine DEM, to be kept (at least 0, at most 1)"""
    ...

def rocks_from_shadows(*, method: str = ..., min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ..., blur: float = ...) -> dict[str, Any]:
    """Finds rocks in an image by their shadows, with widths, heights and confidence.

    method: Segmentation of shadows: shadow (against the ground around each), classic (one threshold, as published) (one of shadow, classic)
    min_diameter: Smallest rock kept, in pixels of the image (at least 0.5, at most 10000)
    max_diameter: Largest rock kept, in pixels of the image (at least 1, at most 100000)
    min_confidence: Rocks less probable than this are left out (at least 0, at most 1)
    blur: Standard deviation of the camera's point spread, in pixels; 0: unknown, uses 0.6 (at least 0, at most 5)"""
    ...

def trees_from_canopy(*, preset: str = ..., method: str = ..., min_height: float = ..., isolation_base: float = ..., isolation_slope: float = ..., prominence: float = ..., smoothing: float = ..., crowns: bool = ..., max_crown_radius: float = ..., allometry: str = ..., species: str = ..., roofs: str = ...) -> dict[str, Any]:
    """Finds treetops and crowns in canopy models; stem diameters by allometry.

    preset: Parameters for a type of forest; see docs/methods/trees.md (one of conifer, broadleaf, mixed)
    method: peaks (smoothing, isolation, prominence) or lmf (variable-window local maxima, the reference) (one of peaks, lmf)
    min_height [m]: Lowest tree kept (at least 0.5, at most 100)
    isolation_base: A treetop has no higher cell within isolation_base + isolation_slope x height, metres; -1: as the preset (at least -1, at most 100)
    isolation_slope: See isolation_base; -1: as the preset (at least -1, at most 2)
    prominence: Smallest height of a treetop above its saddle to a higher one, metres; -1: as the preset (at least -1, at most 50)
    smoothing: Standard deviation of the smoothing, metres; -1: as the preset (at least -1, at most 20)
    crowns: Outline the crowns; without them trees have no crown diameter
    max_crown_radius: Largest distance of a crown's edge from its top, metres; -1: as the preset (at least -1, at most 40)
    allometry: CSV table that gives stem diameters, as `waymark allometry fit` writes; empty: Jucker et al. 2017
    species: Row of the allometry table; empty: the type of forest (conifer, broadleaf, mixed), else all
    roofs: remove: leave out tops on roofs, as `waymark buildings` finds them; keep: a canopy without houses needs no search (one of keep, remove)"""
    ...

def trees_of_survey() -> dict[str, Any]:
    """Converts the trees of one canopy model to landmarks and assigns their crowns."""
    ...

def value_flights() -> dict[str, Any]:
    """Values trees by the canopy models that show them and that could have; assigns their crowns."""
    ...

def value_landmarks(*, covers: str = ..., spread: str = ..., min_diameter: float = ..., keep_improbable: bool = ...) -> dict[str, Any]:
    """Values landmarks: multiplicity, spread of features, probability of existence.

    covers: Rule for images that cover a landmark: sound (complete, not occluded, at least as sharp as the coarsest that detected it) or paper (eq. 4: footprint and its area) (one of sound, paper)
    spread: Confidence from spread: sound (by scale, absent for one observation) or paper (eqs. 6-7 literally) (one of sound, paper)
    min_diameter: Smallest landmark that an image can detect, in pixels (at least 0, at most 1000)
    keep_improbable: Keep landmarks that are probably false (rocks and craters below 0.5)"""
    ...

def value_surveys() -> dict[str, Any]:
    """Values landmarks without images; a DEM or a table is one survey."""
    ...
