"""What commands print and draw: tables, texts, plots."""
