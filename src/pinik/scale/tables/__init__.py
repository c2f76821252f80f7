"""Tables in files: CSV, JSON Lines, NPZ and Parquet, read and written in chunks of rows."""
