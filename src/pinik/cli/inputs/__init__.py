"""What commands read: robots, targets, options."""
