"""The seeds' results, computed anew: what their tables say, and what this machine says."""
