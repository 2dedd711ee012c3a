-- Version 2 took what nobody could assess for perfect, did not see what other programs move, and did not store how
-- types are seen. Every landmark table also gets the triggers of edits.sql, its quality is computed again, and types
-- get the declaration of the built-in type of their name, or one after their drawing (migrations.cpp).
CREATE TABLE waymark_moved (
  id INTEGER PRIMARY KEY,           -- row of the landmark
  type TEXT NOT NULL,               -- its table
  moved DATETIME NOT NULL           -- UTC
);
ALTER TABLE waymark_type ADD COLUMN evidence TEXT NOT NULL DEFAULT 'none';
ALTER TABLE waymark_type ADD COLUMN body_feature TEXT NOT NULL DEFAULT '';
ALTER TABLE waymark_type ADD COLUMN radius_per_value DOUBLE NOT NULL DEFAULT 1;
ALTER TABLE waymark_type ADD COLUMN identification_reach DOUBLE NOT NULL DEFAULT 100;
ALTER TABLE waymark_type ADD COLUMN identifies_itself BOOLEAN NOT NULL DEFAULT 0;
INSERT INTO gpkg_extensions VALUES
  ('waymark_moved', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write');
INSERT INTO waymark_schema VALUES
  (3, 'quality: NULL where not assessed; landmarks: edit triggers; waymark_moved; types: evidence, body, reach');
