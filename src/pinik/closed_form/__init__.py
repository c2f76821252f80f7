"""Exact solutions for arms of two bones."""
