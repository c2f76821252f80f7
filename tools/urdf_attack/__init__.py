"""Attack the reader of URDF files with mutated robots: what is mutated, how, and what must be true of each input."""
