"""From a question to a solution."""
