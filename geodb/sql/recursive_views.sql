SELECT name FROM sqlite_master
-- Views that may read their own rows, without end. SQLite does not say which do.
WHERE type = 'view' AND upper(sql) LIKE '%UNION%'
  AND ' ' || replace(replace(replace(replace(upper(sql), char(13), ' '), char(10), ' '), char(9), ' '), '(', ' ')
    LIKE '% WITH %'
