-- A Waymark map, version 3: a GeoPackage 1.3 (OGC 12-128r18). Every landmark type adds a table of its own:
-- see landmark_layout.cpp for its columns. Text in {braces} is filled in.

-- GeoPackage core ------------------------------------------------------------------------------------------

CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL,
  srs_id INTEGER PRIMARY KEY,
  organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL,
  definition TEXT NOT NULL,         -- WKT 1, or 'undefined' where only WKT 2 can say it
  description TEXT,
  definition_12_063 TEXT NOT NULL   -- WKT 2; without it QGIS does not know a planetary CRS
);

CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY,
  data_type TEXT NOT NULL,
  identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE,
  srs_id INTEGER REFERENCES gpkg_spatial_ref_sys(srs_id)
);

CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL UNIQUE REFERENCES gpkg_contents(table_name),
  column_name TEXT NOT NULL,
  geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL REFERENCES gpkg_spatial_ref_sys(srs_id),
  z TINYINT NOT NULL,
  m TINYINT NOT NULL,
  PRIMARY KEY (table_name, column_name)
);

CREATE TABLE gpkg_extensions (
  table_name TEXT,
  column_name TEXT,
  extension_name TEXT NOT NULL,
  definition TEXT NOT NULL,
  scope TEXT NOT NULL,
  UNIQUE (table_name, column_name, extension_name)
);

-- GeoPackage extensions: schema, metadata, related tables --------------------------------------------------

CREATE TABLE gpkg_data_columns (
  table_name TEXT NOT NULL,
  column_name TEXT NOT NULL,
  name TEXT,
  title TEXT,
  description TEXT,
  mime_type TEXT,
  constraint_name TEXT,
  PRIMARY KEY (table_name, column_name),
  UNIQUE (table_name, name)
);

CREATE TABLE gpkg_data_column_constraints (
  constraint_name TEXT NOT NULL,
  constraint_type TEXT NOT NULL,
  value TEXT,
  min NUMERIC, min_is_inclusive BOOLEAN,
  max NUMERIC, max_is_inclusive BOOLEAN,
  description TEXT,
  UNIQUE (constraint_name, constraint_type, value)
);

CREATE TABLE gpkg_metadata (
  id INTEGER NOT NULL PRIMARY KEY,
  md_scope TEXT NOT NULL DEFAULT 'dataset',
  md_standard_uri TEXT NOT NULL,
  mime_type TEXT NOT NULL DEFAULT 'text/xml',
  metadata TEXT NOT NULL DEFAULT ''
);

CREATE TABLE gpkg_metadata_reference (
  reference_scope TEXT NOT NULL,
  table_name TEXT,
  column_name TEXT,
  row_id_value INTEGER,
  timestamp DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  md_file_id INTEGER NOT NULL REFERENCES gpkg_metadata(id),
  md_parent_id INTEGER REFERENCES gpkg_metadata(id)
);

CREATE TABLE gpkgext_relations (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  base_table_name TEXT NOT NULL,
  base_primary_column TEXT NOT NULL DEFAULT 'id',
  related_table_name TEXT NOT NULL,
  related_primary_column TEXT NOT NULL DEFAULT 'id',
  relation_name TEXT NOT NULL,
  mapping_table_name TEXT NOT NULL UNIQUE
);

-- How QGIS draws the layers (its own convention) -----------------------------------------------------------

CREATE TABLE layer_styles (
  id INTEGER PRIMARY KEY,
  f_table_catalog TEXT(256) DEFAULT '',
  f_table_schema TEXT(256) DEFAULT '',
  f_table_name TEXT(256),
  f_geometry_column TEXT(256),
  styleName TEXT(30),
  styleQML TEXT,
  styleSLD TEXT,
  useAsDefault BOOLEAN,
  description TEXT,
  owner TEXT(30) DEFAULT '',
  ui TEXT(30),
  update_time DATETIME DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now'))
);

-- Waymark --------------------------------------------------------------------------------------------------

-- One row per step that brought this file to its version; the largest is the version. (PRAGMA user_version
-- belongs to GeoPackage.)
CREATE TABLE waymark_schema (
  version INTEGER PRIMARY KEY,
  description TEXT NOT NULL
);

-- Landmark types, so that programs can read a file with types unknown to them.
CREATE TABLE waymark_type (
  id INTEGER PRIMARY KEY,           -- from 1; rows of its table have ids from (id - 1) * 1e9 + 1
  name TEXT NOT NULL UNIQUE,        -- of the table
  summary TEXT NOT NULL,
  evidence TEXT NOT NULL,           -- how it shows itself: none, shadow_caster, bowl, canopy, upright
  body_feature TEXT NOT NULL,       -- its horizontal extent; '' for none
  radius_per_value DOUBLE NOT NULL, -- of body_feature: 1 for a radius, 0.5 for a diameter
  identification_reach DOUBLE NOT NULL,  -- m: largest range at which a bearing is associated with it
  identifies_itself BOOLEAN NOT NULL,    -- e.g. by a bar code
  drawn_as TEXT NOT NULL,           -- point, sphere, cylinder, cone, bowl
  colour TEXT NOT NULL,             -- #rrggbb
  label_feature TEXT NOT NULL,      -- '' for none
  size_feature TEXT NOT NULL
);

-- Observed features: columns <name>, <name>_sd, <name>_q of the type's table, in the order of position.
CREATE TABLE waymark_feature (
  id INTEGER PRIMARY KEY,
  type TEXT NOT NULL REFERENCES waymark_type(name),
  position INTEGER NOT NULL,        -- from 0
  name TEXT NOT NULL,
  unit TEXT NOT NULL,               -- 'm', 'rad', '' for a pure number
  scale TEXT NOT NULL,              -- ratio, interval, axis, direction
  lowest DOUBLE,                    -- plausible values; NULL: unbounded
  highest DOUBLE,
  reference DOUBLE NOT NULL,        -- spread at which an interval or axis value says nothing
  summary TEXT NOT NULL,
  UNIQUE (type, name), UNIQUE (type, position)
);

-- Facts that are not observed: one column each.
CREATE TABLE waymark_attribute (
  id INTEGER PRIMARY KEY,
  type TEXT NOT NULL REFERENCES waymark_type(name),
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  unit TEXT NOT NULL,
  kind TEXT NOT NULL,               -- real, integer, text
  summary TEXT NOT NULL,
  UNIQUE (type, name), UNIQUE (type, position)
);

-- Single observations of landmarks, projected to the terrain. Accepted rows are linked to their landmark by
-- <type>_observation (related tables extension).
CREATE TABLE observation (
  id INTEGER PRIMARY KEY,
  type TEXT NOT NULL,               -- landmark type
  uid TEXT,                         -- of the landmark; NULL if rejected before it had one
  source TEXT NOT NULL,             -- image name, or the DEM
  pixel_x DOUBLE,                   -- column and row; (0, 0) is the centre of the first pixel
  pixel_y DOUBLE,
  x DOUBLE NOT NULL,                -- map CRS
  y DOUBLE NOT NULL,
  z DOUBLE NOT NULL,                -- m
  var_x DOUBLE,                     -- m2, east and north; NULL: unknown
  var_y DOUBLE,
  cov_xy DOUBLE,
  var_z DOUBLE,                     -- NULL: the height is unknown
  weight DOUBLE NOT NULL,           -- detection quality q(d), (0, 1]
  features TEXT NOT NULL,           -- JSON: {"radius": 1.2, "radius_sd": 0.1}
  rejected TEXT                     -- reason; NULL if kept
);

-- Landmarks that another program moved after Waymark measured them (triggers in edits.sql). A map from Waymark has
-- none; `waymark validate` reports them, and an edit by Waymark takes the row out.
CREATE TABLE waymark_moved (
  id INTEGER PRIMARY KEY,           -- row of the landmark
  type TEXT NOT NULL,               -- its table
  moved DATETIME NOT NULL           -- UTC
);

-- Images and their footprints on the ground. A layer only if there are any.
CREATE TABLE image (
  id INTEGER PRIMARY KEY,
  geom MULTIPOLYGON,                -- footprint; NULL: unknown
  name TEXT NOT NULL UNIQUE,        -- observation.source
  camera TEXT NOT NULL,             -- JSON: model and pose
  taken DATETIME,
  sun_azimuth DOUBLE,               -- deg, clockwise from map north
  sun_elevation DOUBLE,             -- deg above the horizon
  gsd DOUBLE                        -- m
);

-- Provenance of the map.
CREATE TABLE run (
  id INTEGER PRIMARY KEY,
  version TEXT NOT NULL,            -- of Waymark
  command_line TEXT NOT NULL,
  job TEXT NOT NULL,                -- JSON: stages with all options
  inputs TEXT NOT NULL,             -- JSON: [{"path", "bytes", "sha256"}]
  started DATETIME NOT NULL,        -- UTC
  seed INTEGER NOT NULL,
  seconds DOUBLE NOT NULL DEFAULT 0,
  report TEXT NOT NULL DEFAULT '{}' -- JSON: per stage in, out, rejected by reason, seconds, warnings
);

INSERT INTO gpkg_extensions VALUES
  ('gpkg_spatial_ref_sys', 'definition_12_063', 'gpkg_crs_wkt', 'http://www.geopackage.org/spec130/#extension_crs_wkt', 'read-write'),
  ('gpkg_data_columns', NULL, 'gpkg_schema', 'http://www.geopackage.org/spec130/#extension_schema', 'read-write'),
  ('gpkg_data_column_constraints', NULL, 'gpkg_schema', 'http://www.geopackage.org/spec130/#extension_schema', 'read-write'),
  ('gpkg_metadata', NULL, 'gpkg_metadata', 'http://www.geopackage.org/spec130/#extension_metadata', 'read-write'),
  ('gpkg_metadata_reference', NULL, 'gpkg_metadata', 'http://www.geopackage.org/spec130/#extension_metadata', 'read-write'),
  ('waymark_schema', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write'),
  ('waymark_type', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write'),
  ('waymark_feature', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write'),
  ('waymark_attribute', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write'),
  ('waymark_moved', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write');

INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change) VALUES
  ('observation', 'attributes', 'observation', 'The evidence of every landmark', '{time}'),
  ('run', 'attributes', 'run', 'How the map came to be', '{time}'),
  ('layer_styles', 'attributes', 'layer_styles', 'How QGIS draws the layers', '{time}');
