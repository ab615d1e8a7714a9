"""palpate bake, palpate pin."""
