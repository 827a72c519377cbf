"""Faces: found, told apart with the consent of those they are of, and forgotten when asked to."""
