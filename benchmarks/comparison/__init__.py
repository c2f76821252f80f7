"""The parts of `benchmarks/peers.py`: arms and problems, peers and their environments, verdicts, tables."""
