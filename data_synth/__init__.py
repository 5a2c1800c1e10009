"""Synthetic and recorded ship and vehicle records."""
