"""Builders of the ancient monuments, one file per monument or kind. Each adds its elements to a building."""
