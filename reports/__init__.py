"""Figures, tables and pages drawn from plain tables and traces."""
