#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Writes version_1.sql, the old map the migration tests open, from a small map of the present version:
#   make_version_1.sh MAP.gpkg > version_1.sql
# Undoes sql/migrate_2.sql; later migrations are undone before it.
set -e
copy=$(mktemp --suffix=.gpkg)
trap 'rm -f "$copy"' EXIT
cp "$1" "$copy"
sqlite3 "$copy" "ALTER TABLE run DROP COLUMN seconds; ALTER TABLE run DROP COLUMN report;
  ALTER TABLE image DROP COLUMN taken; UPDATE waymark_schema SET version = 1"
echo "PRAGMA application_id = 1196444487; PRAGMA user_version = 10300;"
sqlite3 "$copy" .dump
