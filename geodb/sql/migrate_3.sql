-- Version 2 took what nobody could assess for perfect, and did not see what other programs move. Every landmark table
-- also gets the triggers of edits.sql, and its quality is computed again (migrations.cpp).
CREATE TABLE waymark_moved (
  id INTEGER PRIMARY KEY,           -- row of the landmark
  type TEXT NOT NULL,               -- its table
  moved DATETIME NOT NULL           -- UTC
);
INSERT INTO gpkg_extensions VALUES
  ('waymark_moved', NULL, 'waymark_map', 'docs/map.md of Waymark', 'read-write');
INSERT INTO waymark_schema VALUES (3, 'quality: NULL where not assessed; landmarks: edit triggers; waymark_moved');
