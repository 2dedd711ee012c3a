-- Of landmark table {t}: a landmark seen once of once, with no feature observed twice, has no quality.
UPDATE "{t}" SET quality = NULL WHERE visible < 2{unknown};
