"""What commands show: tables, texts, plots."""
