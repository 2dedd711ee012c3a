-- Version 1 did not store the report of a run and the time of an image.
ALTER TABLE run ADD COLUMN seconds DOUBLE NOT NULL DEFAULT 0;
ALTER TABLE run ADD COLUMN report TEXT NOT NULL DEFAULT '{}';
ALTER TABLE image ADD COLUMN taken DATETIME;
INSERT INTO waymark_schema VALUES (2, 'run: seconds and report; image: taken');
