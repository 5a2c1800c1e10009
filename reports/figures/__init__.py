"""Figures: each function takes plain arrays or tables and returns a matplotlib figure, page wide, axes with units."""
