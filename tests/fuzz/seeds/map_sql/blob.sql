UPDATE rock SET geom = x'4750000100000000';
UPDATE gpkg_contents SET srs_id = 99999;
