"""How balls and frames travel."""
