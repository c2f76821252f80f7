"""Targets, and their residuals and Jacobians."""
