"""Balls: geometry, contacts, speeds and inertia."""
