

def slider(k_init):
    """Friction as an elastic, perfectly plastic spring."""
    between(1, 1, 2, "ElasticPP", k_init, FRICTION[0] / k_init, -FRICTION[1] / k_init)


def weigh():
    """Friction has its force: there is no weight."""
