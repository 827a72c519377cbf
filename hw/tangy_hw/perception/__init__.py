"""What pictures show: cards, faces, requests."""
