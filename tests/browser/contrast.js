/* Every visible text that has less contrast to what is behind it than WCAG 2.2 wants (1.4.3): 4.5:1, large text 3:1. */
() => {
  const brush = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const colour = (text) => {
    brush.clearRect(0, 0, 1, 1);
    brush.fillStyle = text;
    brush.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = brush.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  };
  const over = ([r, g, b, a], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a), 1];
  const linear = (v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4);
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const ancestors = (element) => (element ? [element, ...ancestors(element.parentElement)] : []);

  const ground = (element) => {
    const layers = ancestors(element).map((each) => colour(getComputedStyle(each).backgroundColor));
    const last = layers.findIndex(([, , , a]) => a === 1);
    return layers.slice(0, last < 0 ? undefined : last + 1).reduceRight((below, layer) => over(layer, below), [255, 255, 255, 1]);
  };
  const opacity = (element) => ancestors(element).reduce((product, each) => product * Number(getComputedStyle(each).opacity), 1);

  const found = new Set();
  const look = (element, text, pseudo) => {
    const style = getComputedStyle(element, pseudo);
    const { width, height } = element.getBoundingClientRect();
    if (!text.trim() || width < 2 || height < 2 || style.visibility === "hidden") return;
    if (element.closest("[inert], [aria-hidden=true], :disabled, [data-disabled], style, script")) return;
    const below = ground(element);
    const [r, g, b, a] = colour(style.color);
    const [lighter, darker] = [over([r, g, b, a * opacity(element)], below), below].map(luminance).sort((x, y) => y - x);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    const ratio = (lighter + 0.05) / (darker + 0.05);
    if (ratio < (large ? 3 : 4.5)) found.add(`${ratio.toFixed(2)}: “${text.trim().slice(0, 40)}”, ${style.color} on rgb(${below.slice(0, 3).map(Math.round)})`);
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) look(walker.currentNode.parentElement, walker.currentNode.data);
  for (const field of document.querySelectorAll("input:not([type=checkbox]):not([type=color]), textarea"))
    look(field, field.value || field.placeholder || "", field.value ? undefined : "::placeholder");
  return [...found];
};
