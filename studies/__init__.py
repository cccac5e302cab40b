"""Studies of the product: the demo, errors and times, the pictures of docs. `python -m studies` lists them."""
