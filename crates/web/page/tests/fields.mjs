// Sliders and fields of the page by their labels.

export const slider = (page, label) => page.getByRole("slider", { name: label, exact: true });
export const field = (page, label) => page.getByRole("textbox", { name: label, exact: true });

export async function setField(page, label, text) {
  await field(page, label).fill(text);
  await field(page, label).press("Enter");
  await field(page, label).blur();
}
