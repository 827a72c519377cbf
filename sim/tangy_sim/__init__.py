"""A simulated world: people with cards, their requests and responses, and a robot among them."""
