"""What is asked, as numbers: residuals and Jacobians."""
