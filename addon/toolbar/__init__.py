"""The tool Palpate in the toolbar, its keys and its places in the menus."""
