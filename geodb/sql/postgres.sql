-- What a schema of PostgreSQL has besides the tables of a map, version 1. Tables of the map have the same names and
-- columns, in lower case; those without an integer key have row_number, their order in the file.

CREATE TABLE waymark_postgres (
  version integer NOT NULL,        -- of this layout
  has_postgis boolean NOT NULL,    -- false: geometries are bytes of GeoPackage
  page_size bigint NOT NULL,       -- of the file
  schema_cookie bigint NOT NULL    -- of the file: number of changes of its schema
);

-- Definitions of the file's tables, indexes, views and triggers, from which it is made again.
CREATE TABLE waymark_definition (
  position integer PRIMARY KEY,
  kind text NOT NULL,
  name text NOT NULL,
  sql text NOT NULL
);
