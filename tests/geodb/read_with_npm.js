// SPDX-License-Identifier: Apache-2.0
// Counts the rows of a table with the npm GeoPackage reader: node read_with_npm.js MAP.gpkg TABLE
const { GeoPackageManager } = require('@ngageoint/geopackage');

GeoPackageManager.open(process.argv[2]).then((geopackage) => {
  const table = geopackage.getFeatureDao(process.argv[3]);
  console.log('rows:', table.count());
  for (const row of table.queryForEach()) {
    if (!table.getRow(row).geometry.geometry.hasZ) throw new Error('a geometry has no z');
  }
  geopackage.close();
});
