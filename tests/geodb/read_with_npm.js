// SPDX-License-Identifier: Apache-2.0
// Reads a table with the npm GeoPackage reader, every geometry included: node read_with_npm.js MAP.gpkg TABLE
// It is no dependency of ours. To have it, anywhere but in the repository:
//   npm install @ngageoint/geopackage@4.2.9 better-sqlite3@11.10.0    (the second one is compiled)
//   NODE_PATH=$PWD/node_modules ctest --test-dir .../build/dev -R NpmGeopackage
const { GeoPackageAPI } = require('@ngageoint/geopackage');

GeoPackageAPI.open(process.argv[2]).then((geopackage) => {
  console.log('faults:', geopackage.validate().length);
  const table = geopackage.getFeatureDao(process.argv[3]);
  console.log('rows:', table.count());
  let high = 0;
  for (const row of table.queryForEach()) {
    if (table.getRow(row).geometry.geometry.hasZ) ++high;
  }
  console.log('with z:', high);
  geopackage.close();
});
