"""Equations of a towed cable: reference simulators and reduced models."""
