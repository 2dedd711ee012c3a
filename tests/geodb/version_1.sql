PRAGMA application_id = 1196444487; PRAGMA user_version = 10300;
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL,
  srs_id INTEGER PRIMARY KEY,
  organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL,
  definition TEXT NOT NULL,         -- WKT 1, or 'undefined' where only WKT 2 can say it
  description TEXT,
  definition_12_063 TEXT NOT NULL   -- WKT 2; without it QGIS does not know a planetary CRS
);
INSERT INTO gpkg_spatial_ref_sys VALUES('Undefined Cartesian SRS',-1,'NONE',-1,'undefined','metres on no body','undefined');
INSERT INTO gpkg_spatial_ref_sys VALUES('Undefined geographic SRS',0,'NONE',0,'undefined','degrees','undefined');
INSERT INTO gpkg_spatial_ref_sys VALUES('WGS 84',4326,'EPSG',4326,'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]]','Earth','GEOGCRS["WGS 84",ENSEMBLE["World Geodetic System 1984 ensemble",MEMBER["World Geodetic System 1984 (Transit)"],MEMBER["World Geodetic System 1984 (G730)"],MEMBER["World Geodetic System 1984 (G873)"],MEMBER["World Geodetic System 1984 (G1150)"],MEMBER["World Geodetic System 1984 (G1674)"],MEMBER["World Geodetic System 1984 (G1762)"],MEMBER["World Geodetic System 1984 (G2139)"],ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]],ENSEMBLEACCURACY[2.0]],PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]],CS[ellipsoidal,2],AXIS["geodetic latitude (Lat)",north,ORDER[1],ANGLEUNIT["degree",0.0174532925199433]],AXIS["geodetic longitude (Lon)",east,ORDER[2],ANGLEUNIT["degree",0.0174532925199433]],USAGE[SCOPE["Horizontal component of 3D system."],AREA["World."],BBOX[-90,-180,90,180]],ID["EPSG",4326]]');
INSERT INTO gpkg_spatial_ref_sys VALUES('WGS 84 / UTM zone 32N',32632,'EPSG',32632,'PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","32632"]]','Earth','PROJCRS["WGS 84 / UTM zone 32N",BASEGEOGCRS["WGS 84",ENSEMBLE["World Geodetic System 1984 ensemble",MEMBER["World Geodetic System 1984 (Transit)"],MEMBER["World Geodetic System 1984 (G730)"],MEMBER["World Geodetic System 1984 (G873)"],MEMBER["World Geodetic System 1984 (G1150)"],MEMBER["World Geodetic System 1984 (G1674)"],MEMBER["World Geodetic System 1984 (G1762)"],MEMBER["World Geodetic System 1984 (G2139)"],ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]],ENSEMBLEACCURACY[2.0]],PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]],ID["EPSG",4326]],CONVERSION["UTM zone 32N",METHOD["Transverse Mercator",ID["EPSG",9807]],PARAMETER["Latitude of natural origin",0,ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",8801]],PARAMETER["Longitude of natural origin",9,ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",8802]],PARAMETER["Scale factor at natural origin",0.9996,SCALEUNIT["unity",1],ID["EPSG",8805]],PARAMETER["False easting",500000,LENGTHUNIT["metre",1],ID["EPSG",8806]],PARAMETER["False northing",0,LENGTHUNIT["metre",1],ID["EPSG",8807]]],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],LENGTHUNIT["metre",1]],AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]],USAGE[SCOPE["Engineering survey, topographic mapping."],AREA["Between 6°E and 12°E, northern hemisphere between equator and 84°N, onshore and offshore. Algeria. Austria. Cameroon. Denmark. Equatorial Guinea. France. Gabon. Germany. Italy. Libya. Liechtenstein. Monaco. Netherlands. Niger. Nigeria. Norway. Sao Tome and Principe. Svalbard. Sweden. Switzerland. Tunisia. Vatican City State."],BBOX[0,6,84,12]],ID["EPSG",32632]]');
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY,
  data_type TEXT NOT NULL,
  identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE,
  srs_id INTEGER REFERENCES gpkg_spatial_ref_sys(srs_id)
);
INSERT INTO gpkg_contents VALUES('observation','attributes','observation','The evidence of every landmark','2026-11-21T07:21:14.000Z',NULL,NULL,NULL,NULL,NULL);
INSERT INTO gpkg_contents VALUES('run','attributes','run','How the map came to be','2026-11-21T07:21:14.000Z',NULL,NULL,NULL,NULL,NULL);
INSERT INTO gpkg_contents VALUES('layer_styles','attributes','layer_styles','How QGIS draws the layers','2026-11-21T07:21:14.000Z',NULL,NULL,NULL,NULL,NULL);
INSERT INTO gpkg_contents VALUES('lamp_post','features','lamp_post','Street light','2026-11-21T07:21:14.000Z',412812.44477722793817,5009233.8595539331437,441702.19984371215105,5099718.4808133170009,32632);
INSERT INTO gpkg_contents VALUES('landmark','features','landmark','All landmarks, whatever their type','2026-11-21T07:21:14.000Z',412812.44477722793817,5009233.8595539331437,441702.19984371215105,5099718.4808133170009,32632);
INSERT INTO gpkg_contents VALUES('image','features','image','Images, with the ground they show','2026-11-21T07:21:14.000Z',400000.0,5000000.0,500000.0,5100000.0,32632);
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL UNIQUE REFERENCES gpkg_contents(table_name),
  column_name TEXT NOT NULL,
  geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL REFERENCES gpkg_spatial_ref_sys(srs_id),
  z TINYINT NOT NULL,
  m TINYINT NOT NULL,
  PRIMARY KEY (table_name, column_name)
);
INSERT INTO gpkg_geometry_columns VALUES('lamp_post','geom','POINT',32632,1,0);
INSERT INTO gpkg_geometry_columns VALUES('landmark','geom','POINT',32632,1,0);
INSERT INTO gpkg_geometry_columns VALUES('image','geom','MULTIPOLYGON',32632,0,0);
CREATE TABLE gpkg_extensions (
  table_name TEXT,
  column_name TEXT,
  extension_name TEXT NOT NULL,
  definition TEXT NOT NULL,
  scope TEXT NOT NULL,
  UNIQUE (table_name, column_name, extension_name)
);
INSERT INTO gpkg_extensions VALUES('gpkg_spatial_ref_sys','definition_12_063','gpkg_crs_wkt','http://www.geopackage.org/spec130/#extension_crs_wkt','read-write');
INSERT INTO gpkg_extensions VALUES('gpkg_data_columns',NULL,'gpkg_schema','http://www.geopackage.org/spec130/#extension_schema','read-write');
INSERT INTO gpkg_extensions VALUES('gpkg_data_column_constraints',NULL,'gpkg_schema','http://www.geopackage.org/spec130/#extension_schema','read-write');
INSERT INTO gpkg_extensions VALUES('gpkg_metadata',NULL,'gpkg_metadata','http://www.geopackage.org/spec130/#extension_metadata','read-write');
INSERT INTO gpkg_extensions VALUES('gpkg_metadata_reference',NULL,'gpkg_metadata','http://www.geopackage.org/spec130/#extension_metadata','read-write');
INSERT INTO gpkg_extensions VALUES('waymark_schema',NULL,'waymark_map','docs/map.md of Waymark','read-write');
INSERT INTO gpkg_extensions VALUES('waymark_type',NULL,'waymark_map','docs/map.md of Waymark','read-write');
INSERT INTO gpkg_extensions VALUES('waymark_feature',NULL,'waymark_map','docs/map.md of Waymark','read-write');
INSERT INTO gpkg_extensions VALUES('waymark_attribute',NULL,'waymark_map','docs/map.md of Waymark','read-write');
INSERT INTO gpkg_extensions VALUES('lamp_post','geom','gpkg_rtree_index','http://www.geopackage.org/spec130/#extension_rtree','write-only');
INSERT INTO gpkg_extensions VALUES('gpkgext_relations',NULL,'gpkg_related_tables','http://www.geopackage.org/18-000.html','read-write');
INSERT INTO gpkg_extensions VALUES('lamp_post_observation',NULL,'gpkg_related_tables','http://www.geopackage.org/18-000.html','read-write');
INSERT INTO gpkg_extensions VALUES('image','geom','gpkg_rtree_index','http://www.geopackage.org/spec130/#extension_rtree','write-only');
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
INSERT INTO gpkg_data_columns VALUES('lamp_post','id','id','id','Row; unique over all landmark types of the map',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','geom','geom','position','Position and height in the map''s CRS',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','uid','uid','uid','Name that stays the same over runs',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','height','height','height (m)','Above the ground',NULL,'lamp_post_height_range');
INSERT INTO gpkg_data_columns VALUES('lamp_post','height_sd','height_sd','height spread (m)','Standard deviation of the observations; NULL where one observation gives no spread',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','height_q','height_q','q of height','Variance confidence, 0 to 1; NULL where one observation gives no spread',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','diameter','diameter','diameter (m)','Of the pole',NULL,'lamp_post_diameter_range');
INSERT INTO gpkg_data_columns VALUES('lamp_post','diameter_sd','diameter_sd','diameter spread (m)','Standard deviation of the observations; NULL where one observation gives no spread',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','diameter_q','diameter_q','q of diameter','Variance confidence, 0 to 1; NULL where one observation gives no spread',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','seen','seen','seen','Images or surveys that detected it',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','visible','visible','visible','Images or surveys that could have',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','q_multiplicity','q_multiplicity','q_#','Multiplicity confidence seen / visible, 0 to 1',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','quality','quality','quality','Landmark quality with equal feature weights, 0 to 1',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','confidence','confidence','confidence','Probability that the landmark exists, 0 to 1',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','var_x','var_x','east variance (m2)','Variance of the position to the east',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','var_y','var_y','north variance (m2)','Variance of the position to the north',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','cov_xy','cov_xy','east-north covariance (m2)','Covariance of east and north',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','var_z','var_z','height variance (m2)','Variance of the height',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','observations','observations','observations','Observations merged into it',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','bulb','bulb','bulb','Kind of lamp',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','fixtures','fixtures','fixtures','Lamps on it',NULL,NULL);
INSERT INTO gpkg_data_columns VALUES('lamp_post','height_low','height_low','height_low (m)','Certified lower bound of the height',NULL,NULL);
CREATE TABLE gpkg_data_column_constraints (
  constraint_name TEXT NOT NULL,
  constraint_type TEXT NOT NULL,
  value TEXT,
  min NUMERIC, min_is_inclusive BOOLEAN,
  max NUMERIC, max_is_inclusive BOOLEAN,
  description TEXT,
  UNIQUE (constraint_name, constraint_type, value)
);
INSERT INTO gpkg_data_column_constraints VALUES('lamp_post_height_range','range',NULL,2,1,20,1,'plausible values');
INSERT INTO gpkg_data_column_constraints VALUES('lamp_post_diameter_range','range',NULL,0.050000000000000002775,1,0.59999999999999997779,1,'plausible values');
CREATE TABLE gpkg_metadata (
  id INTEGER NOT NULL PRIMARY KEY,
  md_scope TEXT NOT NULL DEFAULT 'dataset',
  md_standard_uri TEXT NOT NULL,
  mime_type TEXT NOT NULL DEFAULT 'text/xml',
  metadata TEXT NOT NULL DEFAULT ''
);
INSERT INTO gpkg_metadata VALUES(1,'dataset','http://purl.org/dc/terms/','text/xml',replace('<metadata xmlns:dc="http://purl.org/dc/elements/1.1/" xmlns:dcterms="http://purl.org/dc/terms/">\n  <dc:title>Semantic map of landmarks</dc:title>\n  <dc:creator>Waymark 0.1.0</dc:creator>\n  <dcterms:created>2026-11-21T07:21:14.000Z</dcterms:created>\n  <dcterms:provenance>waymark run job.json -o map.gpkg</dcterms:provenance>\n  <dc:source>dem &amp; &lt;co&gt;.tif sha256:aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa</dc:source>\n</metadata>\n','\n',char(10)));
CREATE TABLE gpkg_metadata_reference (
  reference_scope TEXT NOT NULL,
  table_name TEXT,
  column_name TEXT,
  row_id_value INTEGER,
  timestamp DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  md_file_id INTEGER NOT NULL REFERENCES gpkg_metadata(id),
  md_parent_id INTEGER REFERENCES gpkg_metadata(id)
);
INSERT INTO gpkg_metadata_reference VALUES('geopackage',NULL,NULL,NULL,'2026-11-21T07:21:14.000Z',1,NULL);
CREATE TABLE gpkgext_relations (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  base_table_name TEXT NOT NULL,
  base_primary_column TEXT NOT NULL DEFAULT 'id',
  related_table_name TEXT NOT NULL,
  related_primary_column TEXT NOT NULL DEFAULT 'id',
  relation_name TEXT NOT NULL,
  mapping_table_name TEXT NOT NULL UNIQUE
);
INSERT INTO gpkgext_relations VALUES(1,'lamp_post','id','observation','id','attributes','lamp_post_observation');
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
INSERT INTO layer_styles VALUES(1,'','','lamp_post','geom','lamp_post',replace('<!DOCTYPE qgis PUBLIC ''http://mrcc.com/qgis.dtd'' ''SYSTEM''>\n<qgis version="3.22" styleCategories="Symbology|Labeling" labelsEnabled="1">\n  <renderer-v2 type="singleSymbol" forceraster="0" symbollevels="0" enableorderby="0">\n    <symbols>\n      <symbol type="marker" name="0" alpha="1" clip_to_extent="1" force_rhr="0">\n        <layer class="SimpleMarker" enabled="1" locked="0" pass="0">\n          <Option type="Map">\n            <Option name="name" value="hexagon" type="QString"/>\n            <Option name="color" value="208,160,32,255" type="QString"/>\n            <Option name="outline_color" value="255,255,255,255" type="QString"/>\n            <Option name="outline_style" value="solid" type="QString"/>\n            <Option name="outline_width" value="0.2" type="QString"/>\n            <Option name="outline_width_unit" value="MM" type="QString"/>\n            <Option name="size" value="2.4" type="QString"/>\n            <Option name="size_unit" value="MM" type="QString"/>\n            <Option name="scale_method" value="diameter" type="QString"/>\n          </Option>\n          <data_defined_properties><Option type="Map"><Option name="name" value="" type="QString"/><Option name="properties" type="Map"><Option name="size" type="Map"><Option name="active" value="true" type="bool"/><Option name="expression" value="1.6 + coalesce(log10(1 + max(0, &quot;height&quot;)), 0)" type="QString"/><Option name="type" value="3" type="int"/></Option></Option><Option name="type" value="collection" type="QString"/></Option></data_defined_properties>\n        </layer>\n      </symbol>\n    </symbols>\n  </renderer-v2>\n  <labeling type="simple">\n    <settings calloutType="simple">\n      <text-style fieldName="round(&quot;height&quot;, if(abs(&quot;height&quot;) &lt; 100, 1, 0))" isExpression="1" fontFamily="Sans" namedStyle="Regular" fontSize="8" fontSizeUnit="Point" textColor="40,40,40,255" textOpacity="1">\n        <text-buffer bufferDraw="1" bufferSize="0.8" bufferSizeUnits="MM" bufferColor="255,255,255,255" bufferOpacity="0.85" bufferNoFill="1"/>\n      </text-style>\n      <placement placement="6" dist="1" distUnits="MM" offsetType="1" priority="5" predefinedPositionOrder="TR,TL,BR,BL,R,L,TSR,BSR"/>\n      <rendering drawLabels="1" obstacle="1" obstacleFactor="1" displayAll="0" scaleVisibility="0"/>\n      <dd_properties><Option type="Map"><Option name="name" value="" type="QString"/><Option name="properties" type="Map"><Option name="Priority" type="Map"><Option name="active" value="true" type="bool"/><Option name="expression" value="min(10, 2.5 * coalesce(log10(1 + abs(&quot;height&quot;)), 0))" type="QString"/><Option name="type" value="3" type="int"/></Option></Option><Option name="type" value="collection" type="QString"/></Option></dd_properties>\n    </settings>\n  </labeling>\n  <layerGeometryType>0</layerGeometryType>\n</qgis>\n','\n',char(10)),replace('<?xml version="1.0" encoding="UTF-8"?>\n<StyledLayerDescriptor xmlns="http://www.opengis.net/sld" xmlns:ogc="http://www.opengis.net/ogc" version="1.1.0">\n  <NamedLayer>\n    <Name>lamp_post</Name>\n    <UserStyle>\n      <FeatureTypeStyle>\n        <Rule>\n          <PointSymbolizer>\n            <Graphic>\n              <Mark>\n                <WellKnownName>circle</WellKnownName>\n                <Fill><SvgParameter name="fill">#d0a020</SvgParameter><SvgParameter name="fill-opacity">1</SvgParameter></Fill>\n                <Stroke><SvgParameter name="stroke">#ffffff</SvgParameter></Stroke>\n              </Mark>\n              <Size>9</Size>\n            </Graphic>\n          </PointSymbolizer>\n          <TextSymbolizer>\n            <Label><ogc:PropertyName>height</ogc:PropertyName></Label>\n            <Font><SvgParameter name="font-size">11</SvgParameter></Font>\n            <Halo><Radius>1</Radius></Halo>\n          </TextSymbolizer>\n        </Rule>\n      </FeatureTypeStyle>\n    </UserStyle>\n  </NamedLayer>\n</StyledLayerDescriptor>\n','\n',char(10)),1,'Street light','',NULL,'2026-11-21T07:21:14.000Z');
CREATE TABLE waymark_schema (
  version INTEGER PRIMARY KEY,
  description TEXT NOT NULL
);
INSERT INTO waymark_schema VALUES(1,'created');
CREATE TABLE waymark_type (
  id INTEGER PRIMARY KEY,           -- from 1; rows of its table have ids from (id - 1) * 1e9 + 1
  name TEXT NOT NULL UNIQUE,        -- of the table
  summary TEXT NOT NULL,
  drawn_as TEXT NOT NULL,           -- point, sphere, cylinder, cone, bowl
  colour TEXT NOT NULL,             -- #rrggbb
  label_feature TEXT NOT NULL,      -- '' for none
  size_feature TEXT NOT NULL
);
INSERT INTO waymark_type VALUES(1,'lamp_post','Street light','cylinder','#d0a020','height','height');
CREATE TABLE waymark_feature (
  id INTEGER PRIMARY KEY,
  type TEXT NOT NULL REFERENCES waymark_type(name),
  position INTEGER NOT NULL,        -- from 0
  name TEXT NOT NULL,
  unit TEXT NOT NULL,               -- 'm', 'rad', '' for a pure number
  scale TEXT NOT NULL,              -- ratio, interval, axis
  lowest DOUBLE,                    -- plausible values; NULL: unbounded
  highest DOUBLE,
  reference DOUBLE NOT NULL,        -- spread at which an interval or axis value says nothing
  summary TEXT NOT NULL,
  UNIQUE (type, name), UNIQUE (type, position)
);
INSERT INTO waymark_feature VALUES(1,'lamp_post',0,'height','m','ratio',2.0,20.0,0.0,'Above the ground');
INSERT INTO waymark_feature VALUES(2,'lamp_post',1,'diameter','m','ratio',0.050000000000000002775,0.59999999999999997779,0.0,'Of the pole');
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
INSERT INTO waymark_attribute VALUES(1,'lamp_post',0,'bulb','','text','Kind of lamp');
INSERT INTO waymark_attribute VALUES(2,'lamp_post',1,'fixtures','','integer','Lamps on it');
INSERT INTO waymark_attribute VALUES(3,'lamp_post',2,'height_low','m','real','Certified lower bound of the height');
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
  var_x DOUBLE NOT NULL,            -- m2, east and north
  var_y DOUBLE NOT NULL,
  cov_xy DOUBLE NOT NULL,
  var_z DOUBLE NOT NULL,
  weight DOUBLE NOT NULL,           -- detection quality q(d), (0, 1]
  features TEXT NOT NULL,           -- JSON: {"radius": 1.2, "radius_sd": 0.1}
  rejected TEXT                     -- reason; NULL if kept
);
INSERT INTO observation VALUES(1,'lamp_post','lp-0','image_1',10.499999999999999999,0.0,441702.19984371215105,5099718.4808133170009,72.03244892880320549,1.0,1.0,0.0,4.0,0.69999999999999995559,'{"height":14.190688334405422,"height_sd":0.1}',NULL);
INSERT INTO observation VALUES(2,'lamp_post','lp-1','image_1',10.499999999999999999,1.0,412812.44477722793817,5030233.2567749544977,99.904051539488136768,1.0,1.0,0.0,4.0,0.69999999999999995559,'{"height":4.761070710606873,"height_sd":0.1}',NULL);
INSERT INTO observation VALUES(3,'lamp_post',NULL,'image_1',10.499999999999999999,0.0,441702.19984371215105,5099718.4808133170009,72.03244892880320549,1.0,1.0,0.0,4.0,0.69999999999999995559,'{"height":14.190688334405422,"height_sd":0.1}','height is implausible');
CREATE TABLE image (
  id INTEGER PRIMARY KEY,
  geom MULTIPOLYGON,                -- footprint; NULL: unknown
  name TEXT NOT NULL UNIQUE,        -- observation.source
  camera TEXT NOT NULL,             -- JSON: model and pose
  sun_azimuth DOUBLE,               -- deg, clockwise from map north
  sun_elevation DOUBLE,             -- deg above the horizon
  gsd DOUBLE                        -- m
);
INSERT INTO image VALUES(1,X'47500003787f000000000000006a18410000000080841e4100000000d012534100000000787453410106000000010000000103000000010000000400000000000000006a184100000000d01253410000000080841e4100000000d01253410000000080841e41000000007874534100000000006a184100000000d0125341','image_1','{"model":"pinhole"}',135.0,40.0,0.2000000000000000111);
CREATE TABLE run (
  id INTEGER PRIMARY KEY,
  version TEXT NOT NULL,            -- of Waymark
  command_line TEXT NOT NULL,
  job TEXT NOT NULL,                -- JSON: stages with all options
  inputs TEXT NOT NULL,             -- JSON: [{"path", "bytes", "sha256"}]
  started DATETIME NOT NULL,        -- UTC
  seed INTEGER NOT NULL);
INSERT INTO run VALUES(1,'0.1.0','waymark run job.json -o map.gpkg','{"name":"test","stages":[]}','[{"path":"dem & <co>.tif","bytes":1234,"sha256":"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"}]','2026-11-21T07:21:14.000Z',42);
CREATE TABLE IF NOT EXISTS "lamp_post" (
  "id" INTEGER PRIMARY KEY,
  "geom" POINT,
  "uid" TEXT NOT NULL,
  "height" DOUBLE,
  "height_sd" DOUBLE,
  "height_q" DOUBLE,
  "diameter" DOUBLE,
  "diameter_sd" DOUBLE,
  "diameter_q" DOUBLE,
  "seen" INTEGER NOT NULL,
  "visible" INTEGER NOT NULL,
  "q_multiplicity" DOUBLE,
  "quality" DOUBLE,
  "confidence" DOUBLE NOT NULL,
  "var_x" DOUBLE NOT NULL,
  "var_y" DOUBLE NOT NULL,
  "cov_xy" DOUBLE NOT NULL,
  "var_z" DOUBLE NOT NULL,
  "observations" INTEGER NOT NULL,
  "bulb" TEXT,
  "fixtures" INTEGER,
  "height_low" DOUBLE
);
INSERT INTO lamp_post VALUES(1,X'47500001787f000001e903000080ae73c73132194138006f50563053410000fdfadbf95840','lp-1',4.7610707106068730354,0.2000000000000000111,0.9000000000000000222,NULL,NULL,NULL,3,4,0.75,0.6750000000000000444,0.8000000000000000444,0.25,0.5,0.10000000000000000555,1.0,4,'sodium',1,2.5);
INSERT INTO lamp_post VALUES(2,X'47500001787f000001e903000000602b97e3da194180ee0277d41b5341000032b93bd44340','lp-2',5.2351225353777408599,0.2000000000000000111,0.9000000000000000222,0.25516429608687762886,NULL,NULL,3,4,0.75,0.6750000000000000444,0.8000000000000000444,0.25,0.5,0.10000000000000000555,1.0,4,'sodium',2,2.5);
INSERT INTO lamp_post VALUES(3,X'47500001787f000001e903000080d4a3cc98f51a4138a5c59e317453410000aca413025240','lp-0',14.19068833440542221,0.2000000000000000111,0.9000000000000000222,0.10004575243219733515,NULL,NULL,3,4,0.75,0.6750000000000000444,0.8000000000000000444,0.25,0.5,0.10000000000000000555,1.0,4,NULL,0,2.5);
PRAGMA writable_schema=ON;
INSERT INTO sqlite_schema(type,name,tbl_name,rootpage,sql)VALUES('table','rtree_lamp_post_geom','rtree_lamp_post_geom',0,'CREATE VIRTUAL TABLE "rtree_lamp_post_geom" USING rtree(id, minx, maxx, miny, maxy)');
CREATE TABLE IF NOT EXISTS "rtree_lamp_post_geom_rowid"(rowid INTEGER PRIMARY KEY,nodeno);
INSERT INTO rtree_lamp_post_geom_rowid VALUES(1,1);
INSERT INTO rtree_lamp_post_geom_rowid VALUES(2,1);
INSERT INTO rtree_lamp_post_geom_rowid VALUES(3,1);
CREATE TABLE IF NOT EXISTS "rtree_lamp_post_geom_node"(nodeno INTEGER PRIMARY KEY,data);
INSERT INTO rtree_lamp_post_geom_node VALUES(1,X'00000003000000000000000148c9918e48c9918f4a9982b24a9982b3000000000000000248ced71c48ced71d4a98dea34a98dea4000000000000000348d7acc648d7acc74a9ba18c4a9ba18d000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000');
CREATE TABLE IF NOT EXISTS "rtree_lamp_post_geom_parent"(nodeno INTEGER PRIMARY KEY,parentnode);
CREATE TABLE IF NOT EXISTS "lamp_post_observation" (base_id INTEGER NOT NULL, related_id INTEGER NOT NULL);
INSERT INTO lamp_post_observation VALUES(3,1);
INSERT INTO lamp_post_observation VALUES(1,2);
INSERT INTO sqlite_schema(type,name,tbl_name,rootpage,sql)VALUES('table','rtree_image_geom','rtree_image_geom',0,'CREATE VIRTUAL TABLE "rtree_image_geom" USING rtree(id, minx, maxx, miny, maxy)');
CREATE TABLE IF NOT EXISTS "rtree_image_geom_rowid"(rowid INTEGER PRIMARY KEY,nodeno);
INSERT INTO rtree_image_geom_rowid VALUES(1,1);
CREATE TABLE IF NOT EXISTS "rtree_image_geom_node"(nodeno INTEGER PRIMARY KEY,data);
INSERT INTO rtree_image_geom_node VALUES(1,X'00000001000000000000000148c3500048f424004a9896804a9ba3c0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000');
CREATE TABLE IF NOT EXISTS "rtree_image_geom_parent"(nodeno INTEGER PRIMARY KEY,parentnode);
DELETE FROM sqlite_sequence;
INSERT INTO sqlite_sequence VALUES('gpkgext_relations',1);
CREATE UNIQUE INDEX "lamp_post_uid" ON "lamp_post" (uid);
CREATE TRIGGER "rtree_lamp_post_geom_insert" AFTER INSERT ON "lamp_post"
  WHEN (new."geom" NOT NULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  INSERT OR REPLACE INTO "rtree_lamp_post_geom" VALUES (NEW."id",
    ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"), ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER "rtree_lamp_post_geom_update1" AFTER UPDATE OF "geom" ON "lamp_post"
  WHEN OLD."id" = NEW."id" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  INSERT OR REPLACE INTO "rtree_lamp_post_geom" VALUES (NEW."id",
    ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"), ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER "rtree_lamp_post_geom_update2" AFTER UPDATE OF "geom" ON "lamp_post"
  WHEN OLD."id" = NEW."id" AND (NEW."geom" ISNULL OR ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM "rtree_lamp_post_geom" WHERE id = OLD."id";
END;
CREATE TRIGGER "rtree_lamp_post_geom_update3" AFTER UPDATE ON "lamp_post"
  WHEN OLD."id" != NEW."id" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM "rtree_lamp_post_geom" WHERE id = OLD."id";
  INSERT OR REPLACE INTO "rtree_lamp_post_geom" VALUES (NEW."id",
    ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"), ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER "rtree_lamp_post_geom_update4" AFTER UPDATE ON "lamp_post"
  WHEN OLD."id" != NEW."id" AND (NEW."geom" ISNULL OR ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM "rtree_lamp_post_geom" WHERE id IN (OLD."id", NEW."id");
END;
CREATE TRIGGER "rtree_lamp_post_geom_delete" AFTER DELETE ON "lamp_post"
  WHEN old."geom" NOT NULL
BEGIN
  DELETE FROM "rtree_lamp_post_geom" WHERE id = OLD."id";
END;
CREATE INDEX "lamp_post_observation_base" ON "lamp_post_observation" (base_id);
CREATE VIEW landmark AS
SELECT t.id AS id, k.name AS type, t.geom AS geom, t.uid AS uid, t.quality AS quality, t.seen AS seen,
  t.visible AS visible, t.q_multiplicity AS q_multiplicity, t.confidence AS confidence, t.var_x AS var_x,
  t.var_y AS var_y, t.cov_xy AS cov_xy, t.var_z AS var_z, t.observations AS observations
  FROM "lamp_post" t, waymark_type k WHERE k.name = 'lamp_post';
CREATE INDEX observation_uid ON observation (uid);
CREATE TRIGGER "rtree_image_geom_insert" AFTER INSERT ON "image"
  WHEN (new."geom" NOT NULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  INSERT OR REPLACE INTO "rtree_image_geom" VALUES (NEW."id",
    ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"), ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER "rtree_image_geom_update1" AFTER UPDATE OF "geom" ON "image"
  WHEN OLD."id" = NEW."id" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  INSERT OR REPLACE INTO "rtree_image_geom" VALUES (NEW."id",
    ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"), ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER "rtree_image_geom_update2" AFTER UPDATE OF "geom" ON "image"
  WHEN OLD."id" = NEW."id" AND (NEW."geom" ISNULL OR ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM "rtree_image_geom" WHERE id = OLD."id";
END;
CREATE TRIGGER "rtree_image_geom_update3" AFTER UPDATE ON "image"
  WHEN OLD."id" != NEW."id" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM "rtree_image_geom" WHERE id = OLD."id";
  INSERT OR REPLACE INTO "rtree_image_geom" VALUES (NEW."id",
    ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"), ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER "rtree_image_geom_update4" AFTER UPDATE ON "image"
  WHEN OLD."id" != NEW."id" AND (NEW."geom" ISNULL OR ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM "rtree_image_geom" WHERE id IN (OLD."id", NEW."id");
END;
CREATE TRIGGER "rtree_image_geom_delete" AFTER DELETE ON "image"
  WHEN old."geom" NOT NULL
BEGIN
  DELETE FROM "rtree_image_geom" WHERE id = OLD."id";
END;
PRAGMA writable_schema=OFF;
COMMIT;
