"""What commands are given: robots, targets, options."""
