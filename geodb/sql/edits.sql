-- Triggers of landmark table {t} for editors such as QGIS. A landmark that is added gets a name; one that is moved is
-- noted in waymark_moved, since its features, accuracies and quality were measured at the old position.
CREATE TRIGGER "{t}_added" AFTER INSERT ON "{t}" WHEN NEW.uid IS NULL OR NEW.uid = ''
BEGIN
  UPDATE "{t}" SET uid = '{t}-' || lower(hex(randomblob(8))) WHERE id = NEW.id;
END;
CREATE TRIGGER "{t}_moved" AFTER UPDATE OF geom ON "{t}" WHEN OLD.geom IS NOT NEW.geom
BEGIN
  INSERT OR REPLACE INTO waymark_moved VALUES (NEW.id, '{t}', strftime('%Y-%m-%dT%H:%M:%fZ', 'now'));
END;
CREATE TRIGGER "{t}_removed" AFTER DELETE ON "{t}"
BEGIN
  DELETE FROM waymark_moved WHERE id = OLD.id;
END;
