"""Identification: configurations, learning-model loop, scores, studies, command line."""
